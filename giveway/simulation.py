"""The master loop: vehicle FMU, controller, crowd and SUMO, one control step after the other.

The order of one step, from t_k to t_k+1 (Yang & Özgüner 2019, algorithm 1):

1. read: the ego from its FMU, SUMO's own vehicles where SUMO has just stepped;
2. predict the crowd, solve for the force u(k);
3. record the state at t_k and u(k);
4. step the vehicle and the crowd, both from the state at t_k, so that their order is irrelevant;
5. where SUMO's step ends at t_k+1: move everybody there, step SUMO, compare.

All that may raise comes before the moves of 5. The controller sits inside the master, without a
lag of one sample: position and speed do not depend on the force instantaneously, so there is no
algebraic loop.
"""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from controller import ControllerError, Observation
from fmus import FmuError
from giveway.errors import ControlError, CrowdError, VehicleError
from giveway.mirror import Mirror
from giveway.recorder import EgoRow, Recorder
from pedestrian_model import PedestrianModelError

if TYPE_CHECKING:
    from giveway.assembly import Parts

Array = NDArray[np.float64]


class Ending(enum.StrEnum):
    """Why a run ended."""

    COMPLETED = "completed"  # the ego has driven its distance
    TIME_LIMIT = "time limit"  # it has not within the time limit
    SCENARIO_END = "scenario end"  # the scenario's own end came first
    INTERRUPTED = "interrupted"  # the user wanted it to end
    FAILED = "failed"  # an error ended it


@dataclass(frozen=True)
class Progress:
    """Where a run stands, for whoever watches."""

    time: float  # [s] since the ego's departure
    position: float  # [m] driven
    speed: float  # [m/s]
    acting: str  # which controller acts
    pedestrians: int  # still walking


Watcher = Callable[[Progress], None]


class Loop:
    """One run's state and its steps.

    Args:
        parts: what the run is made of, set up and at its initial state.
        recorder: gathers the rows.
    """

    def __init__(self, parts: Parts, recorder: Recorder) -> None:
        self._parts = parts
        self._recorder = recorder
        self._config = parts.config
        self._start = parts.sumo.time
        self._time_step = parts.config.time_step
        self._k = 0
        self._crowd = parts.crowd
        self._present = np.arange(len(parts.spawned.ids))
        self._mirror = Mirror(parts, recorder)
        centre = parts.shape.length / 2 if parts.config.regulation.gap_from == "centre" else 0.0
        self._gap_origin = -centre  # [m] from the front bumper to where gaps are measured from

    @property
    def ledger(self) -> dict[str, int]:
        """Where the pedestrians are: those added are those arrived plus those still walking."""
        added, walking = len(self._parts.spawned.ids), len(self._present)
        return {"added": added, "arrived": added - walking, "walking": walking}

    def run(self, watcher: Watcher | None, interrupted: Callable[[], bool]) -> Ending:
        """Step until the goal, a limit or an interrupt.

        Raises:
            GivewayError: a part failed; everything recorded so far stays recorded.
        """
        try:
            return self._run(watcher, interrupted)
        except FmuError as error:
            raise VehicleError(f"step {self._k}: {error}") from error
        except ControllerError as error:
            raise ControlError(f"controller at step {self._k}: {error}") from error
        except PedestrianModelError as error:
            raise CrowdError(self._blame(error)) from error

    def _blame(self, error: PedestrianModelError) -> str:
        """Name the pedestrian whose state is not finite by its id."""
        state = np.concatenate([self._crowd.position, self._crowd.velocity], axis=1)
        bad = np.flatnonzero(~np.isfinite(state).all(axis=1))
        if not len(bad):
            return f"crowd at step {self._k}: {error}"
        name = self._parts.spawned.ids[self._present[bad[0]]]
        return (
            f"pedestrian '{name}' at step {self._k}: position and velocity "
            f"{state[bad[0]].tolist()}; expected finite numbers [m, m/s]"
        )

    def _run(self, watcher: Watcher | None, interrupted: Callable[[], bool]) -> Ending:
        limit = self._config.time_limit
        last_step = min(limit, self._parts.sumo.end - self._start) / self._time_step - 1e-6
        while True:
            acting = self._observe_and_control()
            vehicle = self._parts.vehicle
            if watcher is not None:
                elapsed = self._k * self._time_step
                crowd = len(self._present)
                watcher(Progress(elapsed, vehicle.position, vehicle.speed, acting, crowd))
            if vehicle.position >= self._config.ego.travel_distance:
                return Ending.COMPLETED
            if self._k >= last_step:
                over = limit / self._time_step - 1e-6 <= self._k
                return Ending.TIME_LIMIT if over else Ending.SCENARIO_END
            if interrupted():
                return Ending.INTERRUPTED
            self._advance()

    def _observe_and_control(self) -> str:
        """Steps 1 to 3; keeps the command for :meth:`_advance`."""
        began = perf_counter()
        parts, vehicle = self._parts, self._parts.vehicle
        speed = vehicle.speed
        front = parts.departure + vehicle.position
        poses = self._mirror.poses
        parts.corridor.fill_poses(poses, front, speed, parts.shape.length / 2)
        closest, reachable = parts.corridor.closest_now(self._crowd.position, front)
        origin = front + self._gap_origin
        gap = closest - origin

        ahead = parts.corridor.nobody
        if reachable and parts.predictor is not None:
            predicted = parts.predictor.predict(self._crowd, poses)
            ahead = parts.corridor.closest_predicted(predicted, front, speed)
        predicted_at = perf_counter()

        decision = parts.regulator.control(Observation(origin, speed, gap, ahead))
        self._force = decision.force
        if not np.isfinite(decision.force):
            msg = (
                f"controller '{decision.acting}' at step {self._k}: force = {decision.force}; "
                "expected a finite number [N]; please report this with the run's config.toml"
            )
            raise ControlError(msg)
        self._began, self._predicted_at, self._controlled_at = began, predicted_at, perf_counter()

        self._recorder.ego(
            EgoRow(
                self._start + self._k * self._time_step,
                vehicle.position,
                parts.path.pose(front),
                speed,
                vehicle.acceleration,
                decision.force,
                gap,
                decision.reference_speed,
                decision.acting,
                decision.reason,
                decision.status,
                decision.iterations,
            )
        )
        self._recorder.crowd(self._present, self._crowd.position, self._crowd.velocity)
        return decision.acting

    def _advance(self) -> None:
        """Steps 4 and 5."""
        parts = self._parts
        recorded_at = perf_counter()
        parts.vehicle.step(self._force)
        vehicle_at = perf_counter()
        self._step_crowd()
        crowd_at = perf_counter()
        self._k += 1
        self._mirror.follow(
            self._k, parts.departure + parts.vehicle.position, self._present, self._crowd
        )
        ended = perf_counter()
        self._recorder.timing(
            self._predicted_at - self._began,
            self._controlled_at - self._predicted_at,
            vehicle_at - recorded_at,
            crowd_at - vehicle_at,
            ended - crowd_at,
            ended - self._began,
        )

    def _step_crowd(self) -> None:
        """Move the crowd under the vehicles at t_k; who has arrived leaves."""
        parts = self._parts
        if not len(self._present):
            return
        parts.crowd_model.advance(self._crowd, self._mirror.vehicles)
        there = parts.arrived(self._crowd)
        if there.any():
            self._mirror.dismiss(self._present[there])
            self._crowd = self._crowd.select(~there)
            self._present = self._present[~there]
