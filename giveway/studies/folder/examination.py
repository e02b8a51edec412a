"""The examination of results: whether the files of a run or study are those that it wrote."""

from pathlib import Path

from giveway.config.files.trust import is_own_folder
from giveway.doctor.finding import Finding, error, note, ok
from giveway.errors import ResultsError
from giveway.gate import DEFINITIONS, MANIFEST, read_json
from giveway.run_data.seal import faults, is_sealed
from giveway.studies.folder.folder_contents import DEFINITION, broken_files, read_manifest
from giveway.studies.folder.store import RECORDS, RecordStore
from giveway.studies.folder.study_folder import StudyFolder

_SUBJECT = "files"


def is_results(folder: Path) -> bool:
    """Return whether a folder holds the results of a run or study."""
    return (folder / MANIFEST).is_file() or (folder / MANIFEST).is_symlink()


def examine_results(folder: Path) -> list[Finding]:
    """Return what is wrong with the results of a run or study, or that all is well.

    Args:
        folder: Results folder.
    """
    try:
        manifest = read_json(folder / MANIFEST)
        if "definition" in manifest or (folder / DEFINITION).exists():
            return _of_study(folder)
    except (ResultsError, OSError) as problem:
        return [error(_SUBJECT, str(problem), "copy the folder again, or make the results again")]
    if not is_sealed(manifest):
        return [
            note(_SUBJECT, f"{folder}: no seal; an earlier giveway wrote it, or a run is going on")
        ]
    found = faults(folder, manifest)
    remedy = "copy the folder again, or make the run again"
    maker = "this user" if is_own_folder(folder) else "another user, machine or cache folder"
    whole = ok(_SUBJECT, f"{folder}: as the run wrote them; made by {maker}")
    return [error(_SUBJECT, str(fault), remedy) for fault in found] or [whole]


def _of_study(folder: Path) -> list[Finding]:
    """Return the files of a study or risk that are broken.

    Raises:
        ResultsError: the study cannot be read.
    """
    is_risk = (folder / DEFINITIONS["risk"]).exists()
    remedy = f"giveway {'risk' if is_risk else 'study'} with --resume makes it again"
    broken = [
        error(_SUBJECT, f"{file}: is not what giveway wrote", remedy)
        for file in broken_files(folder)
    ]
    if not broken and is_risk:
        return [_of_risk(folder)]
    if not broken:
        runs = len(StudyFolder(folder).records)  # a broken record is an error
        return [ok(_SUBJECT, f"{folder}: as the study wrote them, {runs:,} runs")]
    return broken


def _of_risk(folder: Path) -> Finding:
    """Return how many runs of a risk are there, and whether they are all.

    Raises:
        ResultsError: a record is broken.
    """
    manifest = read_manifest(folder)
    store = RecordStore(folder, manifest["identity"])
    found = [store.get(file.stem) for file in sorted((folder / RECORDS).glob("*/*.json"))]
    told = f"{folder}: as the risk wrote them, {len(found):,} runs"
    if manifest["complete"]:
        return ok(_SUBJECT, told)
    return note(_SUBJECT, f"{told}; not all are there", "go on with giveway risk and --resume")
