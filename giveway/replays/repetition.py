"""The repetition of a run to record its predictions."""

import contextlib
import sys
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

from giveway.gate import LARGEST_TABLE, read_bytes
from giveway.processes.causes import text_in
from giveway.processes.interrupts import ended_by
from giveway.processes.supervisor import journal_folder, supervise
from giveway.replays.run_folder import PREDICTIONS

PERIOD = 0.25  # Time [s] between two predicted positions


@dataclass(frozen=True)
class Predicted:
    """The predictions of a repeated run.

    Attributes:
        file: File with the predictions, which exists until the context is left, or None.
        remark: Reason why there are none; empty if there are some.
    """

    file: Path | None
    remark: str = ""


@contextlib.contextmanager
def predicted_again(folder: Path, trusted: Collection[str] = ()) -> Iterator[Predicted]:
    """Repeat the run in ``folder``, in other processes, so that a crash does no harm.

    The predictions count only if the ``ego.csv`` of the repetition begins with the folder's. The
    run may have been interrupted and thus be shorter than the repetition.

    Args:
        folder: Results of ``giveway run``.
        trusted: Code that the folder names and that may run.
    """
    with journal_folder() as journal:
        again, said = journal / "again", journal / "said.txt"
        command = [sys.executable, "-m", "giveway", "run", "--config", str(folder / "config.toml")]
        command += ["--record-predictions", str(PERIOD), "--out", str(again)]
        command += [word for name in trusted for word in ("--trust", name)]
        command += ["--no-twin", "--no-pictures", "--quiet"]
        with said.open("wb") as output:
            verdict = supervise(command, journal, output=output.fileno())
        if verdict.interrupted:
            raise ended_by(verdict.signal)
        yield _compared(folder, again, verdict.message or text_in(said))


def _compared(folder: Path, again: Path, complaint: str) -> Predicted:
    file = again / PREDICTIONS
    if not file.is_file():
        why = (complaint.strip().splitlines() or ["it ended without a word"])[-1]
        return Predicted(None, f"No predictions: the run could not be made again ({why}).")
    before = read_bytes(folder / "ego.csv", largest=LARGEST_TABLE)
    if not (again / "ego.csv").read_bytes().startswith(before):
        return Predicted(
            None,
            "No predictions: made again, the run went differently (another version, or changed "
            "files; see manifest.json).",
        )
    return Predicted(file)
