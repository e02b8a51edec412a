"""The execution of a study's runs: in processes of this machine, or on a Dask cluster.

After any failure of a run (a native crash, a hang, lack of memory), it becomes a
:class:`giveway.studies.record.RunRecord` like any other, and the study goes on.
"""

from collections.abc import Callable

from giveway.studies.execution.executor import Executor, WorkerError
from giveway.studies.execution.limits import HANG_LIMIT, Limits

__all__ = ["HANG_LIMIT", "Executor", "WorkerError", "cluster_executor", "local_executor"]


def local_executor(
    *, jobs: int, hang_limit: float = HANG_LIMIT, run_limit: float | None = None
) -> Executor:
    """Make an executor with ``jobs`` processes of this machine, one run at a time in each.

    Args:
        jobs: Number of processes.
        hang_limit: Wall clock time [s] without progress after which a run is ended. It is five
            times as long while a run is being set up; infinity waits for ever.
        run_limit: Wall clock time [s] of one run, or None for no limit.

    Raises:
        WorkerError: a number cannot be used.
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
    """Make an executor on a Dask cluster: one giveway process for each thread of its workers.

    Args:
        address: Address of the scheduler, as ``tcp:

        host:8786``. For a trial, ``local`` or ``local:N`` makes a cluster of N processes on this
        machine.
        hang_limit: Same as for :func:`local_executor`.
        run_limit: Same as for :func:`local_executor`.
        tell: Function that takes one line when the cluster has to be waited for, or None for
            standard error.

    Raises:
        WorkerError: a number or address cannot be used, or Dask is not installed.
    """
    from giveway.studies.execution.cluster import ClusterExecutor

    return ClusterExecutor(address, Limits.checked(hang_limit, run_limit), tell)
