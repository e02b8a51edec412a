"""Options of computing a study, which its results do not depend on."""

from dataclasses import dataclass

from giveway.errors import ConfigError
from giveway.processes.processors import processors
from giveway.studies.execution import HANG_LIMIT, Executor, cluster_executor, local_executor


@dataclass(frozen=True)
class StudyOptions:
    """The user's wishes apart from the study itself.

    Attributes:
        jobs: Number of worker processes on this machine. None: one per processor that we may use.
        cluster: Address of a Dask scheduler instead, or "local:N".
        resume: True to continue the study in the folder.
        force: True to replace the content of the folder.
        retry_failed: Make failed runs again.
        hang_limit: [s] without progress after which a run's worker is killed.
        run_limit: [s] of wall clock that one run may take; None: no limit.

    Raises:
        ConfigError: two of them contradict each other.
    """

    jobs: int | None = None
    cluster: str | None = None
    resume: bool = False
    force: bool = False
    retry_failed: bool = False
    hang_limit: float = HANG_LIMIT
    run_limit: float | None = None

    def __post_init__(self) -> None:
        if self.resume and self.force:
            raise ConfigError(
                "--resume and --force: contradict each other; expected one: keep the study, or "
                "replace it"
            )
        if self.cluster is not None and self.jobs is not None:
            raise ConfigError(
                "--jobs and --cluster: contradict each other; expected one: a cluster's workers "
                "are counted by its threads"
            )

    def executor(self) -> Executor:
        """The executor that makes the runs.

        Raises:
            WorkerError: a number or an address cannot be used.
        """
        hang, run = self.hang_limit, self.run_limit
        if self.cluster is not None:
            return cluster_executor(self.cluster, hang_limit=hang, run_limit=run)
        jobs = processors() if self.jobs is None else self.jobs
        return local_executor(jobs=jobs, hang_limit=hang, run_limit=run)
