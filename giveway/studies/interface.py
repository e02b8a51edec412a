"""The Python API of studies: one call, and tables as frames."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.study import StudyProgress, run_study
from giveway.studies.study_options import StudyOptions
from giveway.studies.varying import study_of


def study(
    definition: Mapping[str, Any] | str | Path,
    *,
    out: str | Path | None = None,
    jobs: int | None = None,
    resume: bool = False,
    force: bool = False,
    watcher: Callable[[StudyProgress], None] | None = None,
) -> StudyFolder:
    """Run a study: many paired runs in separate processes, and their comparison.

    Args:
        definition: A dictionary with the keys of a study's TOML file (``factors`` at least; 20
            seeds unless ``replications`` says more), a bundled study's name, or a .toml file.
        out: Folder of the study, or None for ``results/study_NAME``.
        jobs: Number of worker processes, or None for one per processor.
        resume: True to continue the study in the folder.
        force: True to replace the content of the folder.
        watcher: Function that is called after every run.

    Returns:
        The study: ``runs``, ``levels``, ``comparison`` and ``failures`` are frames with the columns
        of docs/studies.md.

    Raises:
        GivewayError: one line that says what to do; finished runs are kept.
    """
    wanted, origin = study_of(definition)
    folder = Path(out) if out is not None else Path("results") / f"study_{wanted.name}"
    options = StudyOptions(jobs=jobs, resume=resume, force=force)
    return run_study(wanted, origin, folder, options, watcher)
