"""The result of ``giveway.run``: tables and their views."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from giveway.results.notebook import Picture, Replay, html_table, one_line, plotted, replayed
from giveway.results.run_tables import RunTables

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class RunResult(RunTables):
    """All data that a run left behind, with its views for a prompt or a notebook."""

    def plot(self, kind: Picture = "top_view", ego: int = 0) -> "Figure":
        """Return a picture of the run: from above, or speed, force and gap over time.

        Args:
            kind: ``"top_view"`` or ``"state"``.
            ego: Index of the ego, counted from 0.

        Raises:
            ResultsError: there is no such picture, or no such ego.
        """
        return plotted(self, kind, ego)

    def replay(self) -> Replay:
        """Return the page that plays the run, which a notebook displays and ``save`` keeps.

        Raises:
            ResultsError: the run has no rows, or the disk for temporary files is full.
        """
        return replayed(self)

    def __repr__(self) -> str:
        return one_line(self)

    def _repr_html_(self) -> str:
        return html_table(self)
