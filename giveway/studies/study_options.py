"""The options of a study's computation, on which its results do not depend."""

from dataclasses import dataclass

from giveway.errors import ConfigError
from giveway.processes.processors import processors
from giveway.studies.execution import HANG_LIMIT, Executor, cluster_executor, local_executor


@dataclass(frozen=True)
class StudyOptions:
    """The options that a user sets apart from the study itself.

    Attributes:
        jobs: Number of worker processes on this machine, or None for one per available processor.
        cluster: Address of a Dask scheduler to use instead, or "local:N".
        resume: True to continue the study in the folder.
        force: True to replace the content of the folder.
        retry_failed: True to make failed runs again.
        hang_limit: Time [s] without progress after which a run's worker is killed.
        run_limit: Wall clock time [s] of one run, or None for no limit.

    Raises:
        ConfigError: two options contradict each other.
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
        """Return the executor that makes the runs.

        Raises:
            WorkerError: a number or an address cannot be used.
        """
        hang, run = self.hang_limit, self.run_limit
        if self.cluster is not None:
            return cluster_executor(self.cluster, hang_limit=hang, run_limit=run)
        jobs = processors() if self.jobs is None else self.jobs
        return local_executor(jobs=jobs, hang_limit=hang, run_limit=run)
