"""Examples of pairs: both runs are made again and drawn side by side."""

from collections.abc import Callable, Sequence

from giveway.errors import GivewayError
from giveway.figures.study_pairs import PairSide, pair_figure
from giveway.reports.choice import ExamplePair
from giveway.reports.pictures import Picture
from giveway.reports.wording import quantity, shown_ego
from giveway.results.ego_result import EgoResult
from giveway.results.run_result import RunResult
from giveway.studies.statistics import metric

TITLES = {
    "median": "A typical pair",
    "median with a stop": "A typical pair of those in which a car stops",
    "best": "Where the treatment gains most",
    "worst": "Where the treatment loses most",
    "stop-and-wait": "Both stop and wait",
}


def example_pictures(
    pairs: Sequence[ExamplePair], rerun: Callable[[str], RunResult]
) -> tuple[list[tuple[ExamplePair, Picture]], list[str]]:
    """A picture of each pair, and a sentence for each that could not be made again.

    Args:
        pairs: which ones.
        rerun: makes a run of the study again, by its id.
    """
    drawn, missing = [], []
    for number, pair in enumerate(pairs, start=1):
        try:
            sides = [
                _side(rerun(run), pair, label)
                for run, label in ((pair.run, pair.treatment), (pair.run_baseline, pair.baseline))
            ]
        except (GivewayError, LookupError) as error:
            missing.append(f"{pair.run} and {pair.run_baseline} are not drawn: {error}")
            continue
        drawn.append((pair, _picture(pair, sides, number)))
    return drawn, missing


def _side(result: RunResult, pair: ExamplePair, label: str) -> PairSide:
    ego = _ego(result, pair.ego)
    return PairSide(
        label,
        ego.track,
        ego.config.regulation.safe_distance,
        ego.config.buffer_distance,
    )


def _ego(result: RunResult, name: str) -> EgoResult:
    for ego in result.egos:
        if ego.id == name:
            return ego
    raise LookupError(f"no ego '{name}' in this run")


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
