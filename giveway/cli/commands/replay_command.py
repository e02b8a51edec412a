"""The command ``giveway replay``: a page that plays the run of a results folder."""

import contextlib
import webbrowser
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import NamedTuple

from rich.console import Console

from giveway.cli.screen.printing import print_notes, print_place
from giveway.replays.repetition import Predicted, predicted_again
from giveway.replays.replay_page import content_of, write_beside, write_replay
from giveway.replays.run_folder import PREDICTIONS, RunFolder

_AGAIN = "Making the run once more for its predictions (--no-rerun skips this) ..."


class PlayChoice(NamedTuple):
    """The choice of the user whether a run is made again, and what is used of the folder."""

    rerun: bool = True  # True to repeat a run whose predictions are not recorded
    unsealed: bool = False  # True to play tables that are not what the run wrote; no repetition
    trusted: Collection[str] = ()  # code that the folder names and that may run


_AS_USUAL = PlayChoice()


def replay_command(
    run: Path,
    choice: PlayChoice = _AS_USUAL,
    *,
    out: Path | None = None,
    beside: Path | None = None,
    show: bool = False,
) -> int:
    """Write the replay of a run and return the exit code 0.

    Args:
        run: Results folder.
        choice: Choice of the user.
        out: Page to write, or None for ``replay.html`` in the folder; with another run it is in the
            working folder.
        beside: Results folder of another run, which is played at the same time, or None.
        show: True to open the page in the browser.

    Raises:
        ResultsError: a folder holds no run, or the page cannot be written.
    """
    console = Console()
    if beside is None:
        target = out or run / "replay.html"
        with _predicted(run, console, choice) as predicted:
            write_replay(
                run,
                target,
                predictions=predicted.file,
                remark=predicted.remark,
                unsealed=choice.unsealed,
            )
    else:
        target = out or Path(f"{run.absolute().name}_beside_{beside.absolute().name}.html")
        contents = []
        for folder in (run, beside):
            with _predicted(folder, console, choice) as predicted:
                content = content_of(
                    folder, predicted.file, predicted.remark, unsealed=choice.unsealed
                )
                contents.append(content)
        write_beside(contents, target)
    print_place(console, "Replay", target)
    if show:
        webbrowser.open(target.absolute().as_uri())
    return 0


@contextlib.contextmanager
def _predicted(run: Path, console: Console, choice: PlayChoice) -> Iterator[Predicted]:
    """Yield the predictions of a run, which is repeated for them if this is useful."""
    with contextlib.ExitStack() as stack:
        predicted = Predicted(None)
        folder = RunFolder.read(run, unsealed=choice.unsealed)
        print_notes(folder.seal_note)
        if choice.rerun and not choice.unsealed and _is_worth_it(folder):
            with console.status(_AGAIN):
                if not console.is_terminal:
                    console.print(_AGAIN)
                predicted = stack.enter_context(predicted_again(run, choice.trusted))
            print_notes(predicted.remark)
        yield predicted


def _is_worth_it(folder: RunFolder) -> bool:
    """Return whether a repetition may give predictions that are not recorded.

    A run that crashed is not repeated.
    """
    if (folder.path / PREDICTIONS).is_file() or folder.manifest.get("ending") == "crashed":
        return False
    return any(config.optimises for config in folder.egos.values())
