"""The views of a result in a notebook or at a prompt: one line, a table, pictures, a replay."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from giveway.errors import ResultsError
from giveway.results.digest import digest
from giveway.run_data.tracks import counted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from giveway.results.run_tables import RunTables

Picture = Literal["top_view", "state"]

_HEIGHT = 720  # Height [px] of a replay in a notebook


@dataclass(frozen=True, repr=False)
class Replay:
    """A page that plays a run; a notebook displays it, and it can be saved.

    Attributes:
        html: The whole page, which needs no network.
    """

    html: str

    def save(self, path: str | Path) -> Path:
        """Write the page to a file.

        ResultsError: the file cannot be written.
            ResultsError: it cannot be written.
        """
        target = Path(path)
        try:
            target.write_text(self.html, encoding="utf-8")
        except OSError as error:
            raise ResultsError(f"{target}: cannot be written ({error.strerror})") from error
        return target

    def __repr__(self) -> str:
        return f"<Replay, {len(self.html) / 1e6:.1f} MB; save('replay.html') writes it>"

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{escape(self.html)}" title="replay" width="100%" '
            f'height="{_HEIGHT}" style="border: 0"></iframe>'
        )


def one_line(result: RunTables) -> str:
    """Return the ``repr`` of a result."""
    head = result.head
    simulated = float(result.time[-1] - result.time[0]) if len(result.time) else 0.0
    driver = head["controller"] or "no ego"
    if len(result.egos) > 1:
        driver = f"{len(result.egos)} egos"
    return (
        f"<RunResult {head['scenario']}: {driver}, {counted(head['pedestrians'])}, "
        f"seed {head['seed']}; {head['ending']} after {simulated:.2f} s>"
    )


def html_table(result: RunTables) -> str:
    """Return the most important numbers and the picture from above, for a notebook."""
    rows = []
    for line in digest(result):
        cells = "".join(f'<td style="text-align: right">{escape(v)}</td>' for v in line.values)
        rows.append(
            f'<tr><td style="text-align: left">{line.label}</td>{cells}<td>{line.unit}</td></tr>'
        )
    title = escape(one_line(result)[1:-1].removeprefix("RunResult "))
    return f"<table><caption>{title}</caption>{''.join(rows)}</table>"


def plotted(result: RunTables, kind: Picture, ego: int) -> Figure:
    """Return one of the pictures of a results folder.

    Raises:
        ResultsError: there is no such picture, or no such ego.
    """
    from giveway.results.pictures import crowd_picture, state_picture, top_view_picture

    draw = {"top_view": top_view_picture, "state": state_picture}
    if kind not in draw:
        raise ResultsError(f"kind = {kind!r}: expected one of {', '.join(map(repr, draw))}")
    if not result.egos and kind == "top_view" and result.crowd_track.x.size:
        return crowd_picture(result)
    if not 0 <= ego < len(result.egos):
        raise ResultsError(f"ego = {ego}: the run has {len(result.egos)}, counted from 0")
    return draw[kind](result, result.egos[ego])


def replayed(result: RunTables) -> Replay:
    """Return the page that plays the run, as ``giveway replay`` makes it.

    Raises:
        ResultsError: the run has no rows, or the disk for temporary files is full.
    """
    from giveway.replays import write_replay
    from giveway.results.folder import write_results

    if not len(result.time):
        raise ResultsError("the run ended before its first step: there is nothing to play")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_results(result, folder)
        return Replay(write_replay(folder, folder / "replay.html").read_text(encoding="utf-8"))
