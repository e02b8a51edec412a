"""The delay of each person by the egos: the run compared with its counterfactual run."""

from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.metrics.encroachment import CONTACT, EGO, PERSON
from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.walks import WalkTrack

Basis = Literal["arrival", "route", ""]


class DelayRow:
    """The columns that a counterfactual run adds to a pedestrian's row; empty if not counted."""

    delay: Annotated[
        float,
        Quantity("s", "that the egos cost it, the run against the twin; < 0: it gained time"),
    ]
    delay_by: Annotated[
        str,
        Quantity(None, "arrival: both arrived; route: by what was left of the way when last seen"),
    ]
    detour: Annotated[
        float, Quantity("m", "by which its way became longer than in the twin; < 0: shorter")
    ]
    gave_way: Annotated[
        str,
        Quantity(None, "yes: the ego went first, in the twin not; no; empty: never crossed"),
    ]


DELAY_FIELDS = columns_of(DelayRow)


class Delays(NamedTuple):
    """The delays of n people by the egos, in the order of the run's ids; nan if not counted.

    Attributes:
        delay: Delay (n,) [s].
        basis: Method (n,) by which it was found.
        detour: Detour (n,) [m].
    """

    delay: NDArray[np.float64]
    basis: NDArray[np.str_]
    detour: NDArray[np.float64]


@dataclass(frozen=True)
class DelaySummary:
    """The columns that a counterfactual run adds to the summary; nan if nobody came close."""

    people_delayed: Annotated[
        int, Quantity("persons", "people who came within 30 m of an ego's way and have a delay")
    ]
    people_delay: Annotated[float, Quantity("s", "sum of these people's delays")]
    mean_people_delay: Annotated[float, Quantity("s", "mean of these people's delays")]
    people_delay_95: Annotated[float, Quantity("s", "95th percentile of these people's delays")]
    worst_people_delay: Annotated[float, Quantity("s", "largest one of these people's delays")]
    share_gave_way: Annotated[
        float,
        Quantity(None, "share of people who gave way, of those whose way crossed the ego's"),
    ]
    twin_differs: Annotated[
        bool, Quantity(None, "whether lights or background vehicles did anything else in the twin")
    ]
    traffic_delay: Annotated[
        float,
        Quantity("s", "time loss of background vehicles until the arrival, less that without egos"),
    ]


DELAY_SUMMARY_FIELDS = columns_of(DelaySummary)


def delays(run: WalkTrack, twin: WalkTrack) -> Delays:
    """Compare every person who came close to an ego's path with the same person without egos.

    For a person who reached the last way-point in both runs, the delay is the difference of the two
    instants. For others it is the difference of the remaining lengths at the last instant with
    records in both runs, divided by the desired speed. A person may have several walks (and go on
    by bus in between): the last one that was finished in both runs counts.

    Args:
        run: Walks of the people.
        twin: Walks of the same people in the counterfactual run.

    Raises:
        ValueError: the time steps of the two differ.
    """
    if run.time_step != twin.time_step:
        raise ValueError(f"time steps {run.time_step} and {twin.time_step} s; expected the same")
    count = len(run.ids)
    found = Delays(np.full(count, np.nan), np.full(count, "", dtype="U7"), np.full(count, np.nan))
    ours, theirs = PedestrianGroups(run), PedestrianGroups(twin)
    others = {name: j for j, name in enumerate(twin.ids)}
    for i in np.flatnonzero(run.near).tolist():
        j = others.get(run.ids[i])
        if j is not None:
            walks = _walk(run, ours, i), _walk(twin, theirs, j)
            one = _delay(*walks, run.time_step, float(run.desired_speed[i]))
            found.delay[i], found.basis[i], found.detour[i] = one
    return found


def gave_way(
    run: NDArray[np.str_], twin: NDArray[np.str_], crossed: NDArray[np.bool_]
) -> NDArray[np.str_]:
    """Return whether each of n people gave way to an ego: "yes", "no", or "" without a crossing.

    A person gives way if they let the ego go first, but would have been first without its
    influence, or there together with it.

    Args:
        run: Road user (n,) that was first in the run, as in :class:`Encroachment`.
        twin: Road user (n,) that was first in the counterfactual run.
        crossed: Flags (n,) of the persons who count.
    """
    met = crossed & (run != "")
    yielded = met & (run == EGO) & ((twin == PERSON) | (twin == CONTACT))
    return np.where(met, np.where(yielded, "yes", "no"), "")


def summarise_delays(
    delay: NDArray[np.float64], gave_way: NDArray[np.str_], *, differs: bool, traffic: float
) -> DelaySummary:
    """Summarise the delays of a run in one row.

    Args:
        delay: Delay (n,) [s] of each person; nan if not counted.
        gave_way: Answer (n,) whether each person gave way: "yes", "no" or "".
        differs: True if lights or background vehicles behaved differently in the counterfactual
            run.
        traffic: Delay [s] of the background vehicles; nan if unknown.
    """
    known = delay[np.isfinite(delay)]
    crossed = int(np.count_nonzero(gave_way != ""))
    yielded = int(np.count_nonzero(gave_way == "yes"))
    return DelaySummary(
        people_delayed=known.size,
        people_delay=float(known.sum()),
        mean_people_delay=float(known.mean()) if known.size else np.nan,
        people_delay_95=float(np.percentile(known, 95.0)) if known.size else np.nan,
        worst_people_delay=float(known.max()) if known.size else np.nan,
        share_gave_way=float(yielded / crossed) if crossed else np.nan,
        twin_differs=differs,
        traffic_delay=traffic,
    )


class _Walk(NamedTuple):
    """The records of one person."""

    step: NDArray[np.int64]
    remaining: NDArray[np.float64]  # [m] remaining length of each record
    length: NDArray[np.float64]  # [m] length walked and remaining
    arrivals: NDArray[np.int64]  # control steps of the arrivals


def _walk(track: WalkTrack, groups: PedestrianGroups, i: int) -> _Walk:
    """Return the records of one person."""
    rows = groups.order[groups.bounds[i] : groups.bounds[i + 1]]
    left = track.remaining[rows]
    arrivals = track.arrival_step[track.arrival_pedestrian == i]
    return _Walk(track.step[rows], left, track.walked[rows] + left, arrivals)


def _delay(
    run: _Walk, twin: _Walk, time_step: float, desired_speed: float
) -> tuple[float, Basis, float]:
    """Return the delay [s], the method and the detour [m]."""
    walks = min(len(run.arrivals), len(twin.arrivals))
    if walks:
        ours, theirs = run.arrivals[walks - 1], twin.arrivals[walks - 1]
        lengths = [
            walk.length[max(int(np.searchsorted(walk.step, step)) - 1, 0)]
            for walk, step in ((run, ours), (twin, theirs))
            if len(walk.step)
        ]
        detour = float(lengths[0] - lengths[1]) if len(lengths) == 2 else np.nan
        return float(ours - theirs) * time_step, "arrival", detour
    common = np.intersect1d(run.step, twin.step, assume_unique=True)
    if not common.size or not desired_speed > 0.0:
        return np.nan, "", np.nan
    at, there = (int(np.searchsorted(walk.step, common[-1])) for walk in (run, twin))
    delay = float(run.remaining[at] - twin.remaining[there]) / desired_speed
    return delay, "route", float(run.length[at] - twin.length[there])
