"""The command ``giveway export run``: a results folder in other formats."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from rich.console import Console

from giveway.cli.screen.printing import print_notes, print_place, writing
from giveway.errors import ConfigError, ResultsError, suggestion
from giveway.exports.fcd import write_fcd
from giveway.exports.geojson import write_geojson
from giveway.exports.people import write_jupedsim, write_pedpy
from giveway.exports.sampling import Sampled, sampled
from giveway.exports.trj import write_trj
from giveway.gate import require_no_link
from giveway.replays.run_folder import RunFolder


class _Format(NamedTuple):
    suffix: str  # Suffix of the file's name
    step: float | None  # default step [s], or None for the control step
    write: Callable[[RunFolder, Sampled, Path], str]


def _film(run: RunFolder, samples: Sampled, file: Path) -> str:
    from giveway.exports.film import write_gif, write_mp4  # imports matplotlib

    return (write_gif if file.suffix == ".gif" else write_mp4)(run, samples, file)


FORMATS = {
    "fcd": _Format(".fcd.xml", None, write_fcd),
    "pedpy": _Format(".txt", None, write_pedpy),
    "jupedsim": _Format(".sqlite", None, write_jupedsim),
    "geojson": _Format(".geojson", None, write_geojson),
    "trj": _Format(".trj", 0.1, write_trj),
    "mp4": _Format(".mp4", 0.05, _film),
    "gif": _Format(".gif", 0.1, _film),
}


def export_run_command(
    folder: Path,
    to: str,
    out: Path | None,
    *,
    step: float | None = None,
    force: bool = False,
    unsealed: bool = False,
) -> None:
    """Write a run in another format.

    Args:
        folder: Results folder.
        to: Format, one of ``FORMATS``.
        out: File to write, or None for one beside the results folder, named after it.
        step: Time [s] between two instants, or None for one that suits the format.
        force: True to replace an existing file.
        unsealed: True to use tables that are not what the run wrote.

    Raises:
        GivewayError: one line that says what to do.
    """
    found = FORMATS.get(to)
    if found is None:
        wrong = f"--format {to}: no such format" if to else "--format: missing"
        raise ConfigError(f"{wrong}; {suggestion(to, FORMATS)}")
    run = RunFolder.read(folder, unsealed=unsealed)
    print_notes(run.seal_note)
    file = out or beside(folder, found.suffix)
    _check(file, found.suffix, force=force)
    samples = sampled(run, found.step if step is None else step)
    try:
        with writing(file, "name another file with --out"):
            told = found.write(run, samples, file)
    except BaseException:
        file.unlink(missing_ok=True)  # half a file must not stay
        raise
    console = Console()
    print_place(console, "Written", file)
    console.print(told, highlight=False, markup=False, soft_wrap=True)


def beside(folder: Path, suffix: str) -> Path:
    """Return the file beside a folder that has its name, and a suffix."""
    whole = folder.absolute() if folder.name in {"", ".."} else folder
    return whole.with_name(f"{whole.name}{suffix}")


def _check(file: Path, suffix: str, *, force: bool) -> None:
    """Make sure that the file may be written.

    Raises:
        ResultsError: the name does not fit, or an existing file is not to be replaced.
    """
    require_no_link(file)
    ending = suffix[suffix.rindex(".") :]
    if file.suffix != ending:
        msg = f"--out {file}: expected the name of a {ending} file"
    elif file.is_dir():
        msg = f"--out {file}: is a folder; expected the name of a {ending} file"
    elif file.exists() and not force:
        msg = f"{file}: exists; replace it with --force or name another file with --out"
    else:
        return
    raise ResultsError(msg)
