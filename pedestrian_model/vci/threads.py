"""The threads that step one crowd together, one domain each; the caller's thread is the first."""

from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TYPE_CHECKING, Any

import numpy as np

from pedestrian_model.stepping import FINE
from pedestrian_model.vci.strips import (
    DomainMemory,
    lay_out,
    layout_memory,
    step_domain,
    write_back,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pedestrian_model.arrays import Arrays
    from pedestrian_model.vci.buffers import Workspace


class CrowdThreads:
    """The threads of one model, and their memory.

    The first step starts the other threads. They end when this object is no longer referenced. A
    copy, by pickle or in a forked process, starts its own threads.

    Args:
        threads: Number of threads with the caller's, at least 2.
    """

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self._memories = [DomainMemory() for _ in range(threads)]
        self._layout = layout_memory(threads)
        self._after = np.empty((0, 4))
        self._others: ThreadPoolExecutor | None = None
        self._process = -1

    def __reduce__(self) -> tuple[type[CrowdThreads], tuple[int]]:
        return CrowdThreads, (self.threads,)

    def advance(
        self,
        arrays: Arrays,
        workspace: Workspace,
        vehicles: NDArray[np.float64],
        constants: NDArray[Any],
        dt: float,
        substeps: int,
    ) -> int:
        """Advance the state in place, and return ``FINE`` or the first bad index.

        Args:
            arrays: Arrays of State, Scene and Scratch, one after the other, of at least one person.
            workspace: Workspace that the scratch belongs to.
            vehicles: Vehicles (m, 7).
            constants: Constants of the model.
            dt: Length [s] of a step.
            substeps: Number of steps.
        """
        position, velocity, sorting = arrays[0], arrays[1], workspace.arrays[1]
        n = position.shape[0]
        if len(self._after) < n:
            self._after = np.empty((workspace.capacity, 4))
        for memory in self._memories:
            memory.reserve(workspace)
        bad = FINE
        for step in range(substeps):
            bad = lay_out(position, velocity, sorting, self._layout, constants)
            if bad != FINE:
                break
            self._walk(arrays, vehicles, step * dt, constants, dt)
            bad = write_back(position, velocity, self._after)
        return bad

    def _walk(
        self,
        arrays: Arrays,
        vehicles: NDArray[np.float64],
        travelled: float,
        constants: NDArray[Any],
        dt: float,
    ) -> None:
        """Step all domains, each in its thread, and wait for all of them."""
        rest = (self._after, (vehicles, travelled), (constants, dt))
        futures: list[Future[None]] = []
        pool = self._pool()
        try:
            futures.extend(
                pool.submit(step_domain, arrays, memory.arrays, self._layout, domain, *rest)
                for domain, memory in enumerate(self._memories[1:], 1)
            )
            step_domain(arrays, self._memories[0].arrays, self._layout, 0, *rest)
        finally:
            wait(futures)
        for future in futures:
            future.result()

    def _pool(self) -> ThreadPoolExecutor:
        """Return the pool of the other threads, made anew in a forked process."""
        if self._others is None or self._process != os.getpid():
            self._others = ThreadPoolExecutor(self.threads - 1, "giveway-crowd")
            self._process = os.getpid()
        return self._others
