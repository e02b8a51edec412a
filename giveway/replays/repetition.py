"""A run made once more, with its predictions on record."""

import contextlib
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from giveway.replays.run_folder import PREDICTIONS

PERIOD = 0.25  # [s] of look-ahead between two predicted positions


@dataclass(frozen=True)
class Predicted:
    """The outcome of repeating a run.

    Attributes:
        file: The predictions, until the context is left; None if there are none.
        remark: Reason why there are none.
    """

    file: Path | None
    remark: str = ""


@contextlib.contextmanager
def predicted_again(folder: Path) -> Iterator[Predicted]:
    """Make the run in ``folder`` again, in processes of its own, so that a crash does no harm.

    Its predictions count only if its ``ego.csv`` begins with the bytes of the folder's. A run that
    was interrupted ends earlier than its repetition does.

    Args:
        folder: The results of ``giveway run``.
    """
    with tempfile.TemporaryDirectory(prefix="giveway-replay-", ignore_cleanup_errors=True) as place:
        again = Path(place) / "run"
        command = [sys.executable, "-m", "giveway", "run", "--config", str(folder / "config.toml")]
        command += ["--record-predictions", str(PERIOD), "--out", str(again)]
        command += ["--no-twin", "--no-pictures", "--quiet"]
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, check=False, text=True
        )
        yield _compared(folder, again, done.stderr)


def _compared(folder: Path, again: Path, complaint: str) -> Predicted:
    file = again / PREDICTIONS
    if not file.is_file():
        why = (complaint.strip().splitlines() or ["it ended without a word"])[-1]
        return Predicted(None, f"No predictions: the run could not be made again ({why}).")
    if not (again / "ego.csv").read_bytes().startswith((folder / "ego.csv").read_bytes()):
        return Predicted(
            None,
            "No predictions: made again, the run went differently (another version, or changed "
            "files; see manifest.json).",
        )
    return Predicted(file)
