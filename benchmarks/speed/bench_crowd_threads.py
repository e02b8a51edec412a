"""What a person costs from 1,000 to 100,000 people, by one thread and by several.

    python benchmarks/speed/bench_crowd_threads.py [THREADS]

The crowds of bench_crowd.py at constant density. Each row is taken in turns within one process.
*Elapsed* compares the wall clock, which needs as many idle processors; *processor* compares the
thread CPU time of one thread with that of the longest way through the shared step (sorting, the
slowest domain, taking over): others on the machine hardly show in it, and the waking of threads not
at all. The bits of both are compared.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from time import perf_counter, thread_time
from typing import TYPE_CHECKING, Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bench_crowd import city, our_crowd

from pedestrian_model import Crowd, CrowdModel, Surroundings, Vehicles
from pedestrian_model.vci import threads

if TYPE_CHECKING:
    from collections.abc import Callable

SIZES = (1_000, 3_000, 10_000, 30_000, 100_000)
STEPS = 100_000  # persons' steps in a round


class Stopwatch:
    """The thread CPU time of the kernels of a shared step, by their longest way."""

    def __init__(self) -> None:
        self.domains: list[float] = []
        self.alone = 0.0
        threads.lay_out = self._timed(threads.lay_out, self._add_alone)
        threads.write_back = self._timed(threads.write_back, self._add_alone)
        threads.step_domain = self._timed(threads.step_domain, self.domains.append)

    def _add_alone(self, time: float) -> None:
        self.alone += time

    @staticmethod
    def _timed(kernel: Any, tell: Callable[[float], None]) -> Any:
        def run(*arguments: Any) -> Any:
            start = thread_time()
            result = kernel(*arguments)
            tell(thread_time() - start)
            return result

        return run

    def longest(self) -> float:
        """Of the step since the last call [s]."""
        time = self.alone + max(self.domains, default=0.0)
        self.alone = 0.0
        self.domains.clear()
        return time


def compare(
    crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings, threads: int, watch: Stopwatch
) -> tuple[float, float, float, float]:
    """Elapsed and processor time [s] of a step by one thread, then by several."""
    one, several = CrowdModel(), CrowdModel(threads=threads)
    mine, theirs = crowd.copy(), crowd.copy()
    times: list[tuple[float, float, float, float]] = []
    for _ in range(max(8, STEPS // len(crowd))):
        watch.longest()
        start, cpu = perf_counter(), thread_time()
        one.advance(mine, vehicles, surroundings)
        elapsed, cpu = perf_counter() - start, thread_time() - cpu
        start = perf_counter()
        several.advance(theirs, vehicles, surroundings)
        times.append((elapsed, cpu, perf_counter() - start, watch.longest()))
    if not np.array_equal(mine.position, theirs.position):
        raise SystemExit("the number of threads shows in the result")
    a, b, c, d = (median(column) for column in zip(*times[2:], strict=True))
    return a, b, c, d


def main(threads: int) -> None:
    watch = Stopwatch()
    print(f"one thread against {threads}, 0.5 persons/m^2, dt = 0.05 s")
    print(f"{'':>8} {'':>8} {'CPU, one':>12} {'CPU, several':>13} {'ratio':>10} {'ratio':>8}")
    print(
        f"{'crowd':>8} {'n':>8} {'[ns/person]':>12} {'[ns/person]':>13}"
        f" {'processor':>10} {'elapsed':>8}"
    )
    for name in ("plane", "city"):
        for n in SIZES:
            scene = city(n) if name == "city" else (our_crowd(n), Vehicles.empty(), Surroundings())
            elapsed, cpu, elapsed_shared, cpu_shared = compare(*scene, threads, watch)
            print(
                f"{name:>8} {n:>8} {cpu / n * 1e9:>12.0f} {cpu_shared / n * 1e9:>13.0f}"
                f" {cpu / cpu_shared:>10.2f} {elapsed / elapsed_shared:>8.2f}"
            )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2)
