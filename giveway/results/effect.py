"""The effect of a run's egos on people, from the run and its counterfactual run."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import EGO, Delays, DelaySummary, encroachment, gave_way, summarise_delays
from giveway.run_data.tracks import CrowdTrack, EgoTrack
from giveway.run_data.walks import WalkTrack


@dataclass(frozen=True)
class Effect:
    """The people of a run compared with those of its counterfactual run.

    Attributes:
        run: Walks of the people, until after the last ego's arrival.
        twin: Walks of the same people in the counterfactual run.
        delays: Delay of each person by all egos, in the order of the run's ids.
        yielded: Whether each person (n,) gave way ("yes", "no" or ""), by the ego's id.
        traffic_differs: True if lights or background vehicles differ in the counterfactual run.
        traffic_delay: Delay [s] of the background vehicles, or nan if it is not known.
        seconds: Computing time [s] of the log, the counterfactual run and the comparison.
    """

    run: WalkTrack
    twin: WalkTrack
    delays: Delays
    yielded: Mapping[str, NDArray[np.str_]]
    traffic_differs: bool
    traffic_delay: float
    seconds: float

    def summary(self, ego: str) -> DelaySummary:
        """Return the delays in one row, with the people who gave way to the ego of this id."""
        return summarise_delays(
            self.delays.delay,
            self.yielded[ego],
            differs=self.traffic_differs,
            traffic=self.traffic_delay,
        )


def who_gave_way(
    run: WalkTrack,
    twin: WalkTrack,
    ego: EgoTrack,
    first: int,
    shape: VehicleShape,
    body_radius: float,
) -> NDArray[np.str_]:
    """Return whether each person of the run gave way to an ego (n,): "yes", "no" or "".

    Args:
        run: Walks of the people.
        twin: Walks of the same people in the counterfactual run.
        ego: Rows of the ego.
        first: Control instant at which the ego departed.
        shape: Body of the ego.
        body_radius: Radius of a pedestrian's body [m].
    """
    of_run = _first(run, run.near, ego, first, shape, body_radius)
    places = {name: i for i, name in enumerate(twin.ids)}
    there = np.array([places.get(name, -1) for name in run.ids], dtype=np.int64)
    asked = np.zeros(len(twin.ids) + 1, dtype=np.bool_)
    asked[there[of_run == EGO]] = True
    of_twin = np.append(_first(twin, asked[:-1], ego, first, shape, body_radius), "")[there]
    return gave_way(of_run, of_twin, run.near)


def _first(
    walks: WalkTrack,
    asked: NDArray[np.bool_],
    ego: EgoTrack,
    first: int,
    shape: VehicleShape,
    body_radius: float,
) -> NDArray[np.str_]:
    """Return who was first (n,) for the people ``asked`` (n,), also after the ego's arrival."""
    beside = shape.length + shape.width + body_radius
    x, y = ego.front_x, ego.front_y
    rows = (walks.step >= first) & asked[walks.pedestrian]
    rows &= (walks.x >= x.min() - beside) & (walks.x <= x.max() + beside)
    rows &= (walks.y >= y.min() - beside) & (walks.y <= y.max() + beside)
    track = CrowdTrack(
        walks.step[rows] - first,
        walks.pedestrian[rows],
        walks.x[rows],
        walks.y[rows],
        walks.vx[rows],
        walks.vy[rows],
        walks.ids,
    )
    more = np.arange(1, max(0, walks.last - first - len(ego.time) + 1) + 1)
    clock = np.concatenate([ego.time, ego.time[-1] + walks.time_step * more])
    return encroachment(ego, track, shape, body_radius, clock).first
