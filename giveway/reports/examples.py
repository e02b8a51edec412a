"""Examples of pairs: both runs are made again and drawn side by side."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from giveway.errors import GivewayError
from giveway.figures.studies.study_pairs import PairSide, pair_figure
from giveway.reports.choice import ExamplePair
from giveway.reports.study_pictures import Picture
from giveway.reports.wording import quantity, shown_ego
from giveway.results.run_result import RunResult
from giveway.run_data.tracks import EgoTrack
from giveway.studies.statistics import metric

TITLES = {
    "median": "A typical pair",
    "median with a stop": "A typical pair of those in which a car stops",
    "best": "Where the treatment gains most",
    "worst": "Where the treatment loses most",
    "stop-and-wait": "Both stop and wait",
}


@dataclass(frozen=True)
class Drive:
    """The drive of one ego in a run.

    Attributes:
        ego: Id of the ego.
        track: Track of the run.
        safe_distance: Safe distance d_safe [m].
        buffer_distance: Buffer distance d_buffer [m].
    """

    ego: str
    track: EgoTrack
    safe_distance: float
    buffer_distance: float


def drives_of(result: RunResult) -> list[Drive]:
    """Return the drives of a run's egos."""
    return [
        Drive(ego.id, ego.track, ego.config.regulation.safe_distance, ego.config.buffer_distance)
        for ego in result.egos
    ]


def example_pictures(
    pairs: Sequence[ExamplePair], drives: Callable[[str], Sequence[Drive]]
) -> tuple[list[tuple[ExamplePair, Picture]], list[str]]:
    """Return a picture of each pair, and a sentence for each pair that could not be made again.

    Args:
        pairs: Pairs to draw.
        drives: Function that returns the drives of a run by its id.
    """
    drawn, missing = [], []
    for number, pair in enumerate(pairs, start=1):
        try:
            sides = [
                _side(drives(run), pair, label)
                for run, label in ((pair.run, pair.treatment), (pair.run_baseline, pair.baseline))
            ]
        except (GivewayError, LookupError) as error:
            missing.append(f"{pair.run} and {pair.run_baseline} are not drawn: {error}")
            continue
        drawn.append((pair, _picture(pair, sides, number)))
    return drawn, missing


def _side(drives: Sequence[Drive], pair: ExamplePair, label: str) -> PairSide:
    for drive in drives:
        if drive.ego == pair.ego:
            return PairSide(label, drive.track, drive.safe_distance, drive.buffer_distance)
    raise LookupError(f"no ego '{pair.ego}' in this run")


def _picture(pair: ExamplePair, sides: Sequence[PairSide], number: int) -> Picture:
    known = metric(pair.metric)
    where = f"{pair.context}, " if pair.context else ""
    size = quantity(pair.difference, known.unit)
    caption = (
        f"{where}seed {pair.seed}{shown_ego(pair.ego)}: {pair.treatment} on the left, "
        f"{pair.baseline} on the right. Difference of {known.label}: {size}."
    )
    ends = ", ".join(f"{side.label} drives for {side.ego.time[-1]:.1f} s" for side in sides)
    mark = "" if number == 1 else f"_{number}"
    return Picture(
        name=f"example{mark}",
        section="examples",
        caption=caption,
        alt=f"Speed, gap and force of both runs over time; {ends}.",
        figure=pair_figure(sides, title=f"{where}seed {pair.seed}"),
    )
