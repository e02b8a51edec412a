"""Execution of a study's runs: in processes of this machine, or on a Dask cluster.

Whatever happens to a run (a native crash, a hang, the system out of memory), it becomes a
:class:`giveway.studies.record.RunRecord` like any other; the study goes on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.studies.execution.executor import Executor, WorkerError
from giveway.studies.execution.limits import HANG_LIMIT, Limits

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["HANG_LIMIT", "Executor", "WorkerError", "cluster_executor", "local_executor"]


def local_executor(
    *, jobs: int, hang_limit: float = HANG_LIMIT, run_limit: float | None = None
) -> Executor:
    """Runs in ``jobs`` processes of this machine, one run at a time in each.

    Args:
        jobs: Number of processes.
        hang_limit: Wall clock [s] without progress after which a run is ended; five times that
            while it is being set up; infinity waits for ever.
        run_limit: Wall clock [s] of one run; None: any.

    Raises:
        WorkerError: a number that cannot be used.
    """
    from giveway.studies.execution.local import LocalExecutor

    return LocalExecutor(jobs, Limits.checked(hang_limit, run_limit))


def cluster_executor(
    address: str,
    *,
    hang_limit: float = HANG_LIMIT,
    run_limit: float | None = None,
    tell: Callable[[str], None] | None = None,
) -> Executor:
    """Make an executor on a Dask cluster: one process of ours for each thread of its workers.

    Args:
        address: Address of its scheduler, as ``tcp://host:8786``; ``local`` or ``local:N`` makes a
            cluster
            of N processes on this machine, to try it.
        hang_limit: Same as for :func:`local_executor`.
        run_limit: Same as for :func:`local_executor`.
        tell: takes one line when the cluster has to be waited for; None: to standard error.

    Raises:
        WorkerError: a number or address that cannot be used, or Dask is not installed.
    """
    from giveway.studies.execution.cluster import ClusterExecutor

    return ClusterExecutor(address, Limits.checked(hang_limit, run_limit), tell)
