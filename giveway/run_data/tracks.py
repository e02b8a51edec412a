"""What a run leaves behind, as arrays: the tracks of egos, crowd and background vehicles.

The recorder fills these; metrics, tables and figures read them. Everything is SI, angles are
mathematical (radians, counter-clockwise from +x) and x, y are the network's coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class EgoTrack:
    """The ego at the T control instants t_k; ``front_*`` is the centre of its front bumper."""

    time: NDArray[np.float64]  # (T,) [s]
    position: NDArray[np.float64]  # (T,) [m] travelled along its path since the start
    front_x: NDArray[np.float64]  # (T,) [m]
    front_y: NDArray[np.float64]  # (T,) [m]
    heading: NDArray[np.float64]  # (T,) [rad]
    speed: NDArray[np.float64]  # (T,) [m/s]
    acceleration: NDArray[np.float64]  # (T,) [m/s^2]
    force: NDArray[np.float64]  # (T,) [N] the command applied during [t_k, t_k+1]
    gap: NDArray[np.float64]  # (T,) [m] to the closest pedestrian in front; inf: nobody
    reference_speed: NDArray[np.float64]  # (T,) [m/s] of the controller that acted
    vehicle_gap: NDArray[np.float64]  # (T,) [m] to the closest vehicle in front; inf: none
    stop_gap: NDArray[np.float64]  # (T,) [m] to where a red light stops it; inf: none
    acting: NDArray[np.str_]  # (T,) who acted: "mpc", "pid", "plug-in", "safety"
    reason: NDArray[np.str_]  # (T,) why it acted, e.g. "optimal", "infeasible", "selected"
    solver_status: NDArray[np.str_]  # (T,) of the QP; empty where none ran
    waits_for: NDArray[np.str_]  # (T,) what it stands for, e.g. "person"; empty while it drives
    solver_iterations: NDArray[np.int64]  # (T,)


@dataclass(frozen=True)
class CrowdTrack:
    """The crowd as flat records, one per pedestrian recorded at an instant, in time order."""

    step: NDArray[np.int64]  # (R,) index into the control instants
    pedestrian: NDArray[np.int64]  # (R,) index into ``ids``
    x: NDArray[np.float64]  # (R,) [m] body centre
    y: NDArray[np.float64]  # (R,) [m]
    vx: NDArray[np.float64]  # (R,) [m/s]
    vy: NDArray[np.float64]  # (R,) [m/s]
    ids: tuple[str, ...]  # one per pedestrian
    kinds: tuple[str, ...] = ()  # likewise, as "elderly"; nothing: nobody is of any
    groups: tuple[str, ...] = ()  # likewise, the id of its first member; nothing: there are none

    def during(self, first: int, instants: int) -> CrowdTrack:
        """The records of ``instants`` control instants from ``first`` on, which becomes step 0."""
        a, b = np.searchsorted(self.step, (first, first + instants))
        if first == 0 and b == len(self.step):
            return self
        return CrowdTrack(
            step=self.step[a:b] - first,
            pedestrian=self.pedestrian[a:b],
            x=self.x[a:b],
            y=self.y[a:b],
            vx=self.vx[a:b],
            vy=self.vy[a:b],
            ids=self.ids,
            kinds=self.kinds,
            groups=self.groups,
        )


@dataclass(frozen=True)
class PredictionTrack:
    """Where an ego's controller expected pedestrians to be, as flat records in time order."""

    time: NDArray[np.float64]  # (P,) [s] the control instant of the prediction
    pedestrian: NDArray[np.int64]  # (P,) index into the crowd's ``ids``
    look_ahead: NDArray[np.float64]  # (P,) [s] from that instant on
    x: NDArray[np.float64]  # (P,) [m] body centre
    y: NDArray[np.float64]  # (P,) [m]


@dataclass(frozen=True)
class BackgroundTrack:
    """SUMO's own vehicles as flat records, at SUMO's instants, in time order."""

    time: NDArray[np.float64]  # (B,) [s]
    id: NDArray[np.str_]  # (B,)
    type: NDArray[np.str_]  # (B,) SUMO vType
    x: NDArray[np.float64]  # (B,) [m] front-bumper centre
    y: NDArray[np.float64]  # (B,) [m]
    heading: NDArray[np.float64]  # (B,) [rad]
    speed: NDArray[np.float64]  # (B,) [m/s]
    length: NDArray[np.float64]  # (B,) [m]
    width: NDArray[np.float64]  # (B,) [m]


@dataclass(frozen=True)
class SignalTrack:
    """The states of traffic lights, as changes in time order."""

    time: NDArray[np.float64]  # (S,) [s] from when on
    system: NDArray[np.str_]  # (S,) SUMO's id of the light
    state: NDArray[np.str_]  # (S,) one letter per movement


@dataclass(frozen=True)
class PeopleTrack:
    """Where pedestrians mean to walk and how fast, as flat records in time order.

    A pedestrian's way is the records of one step: where it was then, and each way-point after that.
    """

    step: NDArray[np.int64]  # (P,) index into the control instants, from when on
    pedestrian: NDArray[np.int64]  # (P,) index into the crowd's ``ids``
    desired_speed: NDArray[np.float64]  # (P,) [m/s]
    x: NDArray[np.float64]  # (P,) [m]
    y: NDArray[np.float64]  # (P,) [m]


@dataclass(frozen=True)
class Timings:
    """Computing times of each control step, apart from all that is equal in equal runs."""

    NAMES: ClassVar[tuple[str, ...]] = (
        "prediction",
        "control",
        "vehicle",
        "crowd",
        "sumo",
        "total",
    )

    seconds: NDArray[np.float64]  # (T, 6) [s], columns in the order of NAMES

    def total(self, name: str) -> float:
        """The sum over all steps of one part [s]."""
        return float(self.seconds[:, self.NAMES.index(name)].sum())
