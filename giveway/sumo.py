"""The one object that owns libsumo.

SUMO is the mirror of our own state: the ego and the pedestrians are moved to where the vehicle
FMU and the VCI model put them, and what is exported is our state. The ways of moving were found
by experiment on SUMO 1.28:

* a person follows ``moveToXY(..., keepRoute=2, matchThreshold=-1)`` exactly; other arguments kill
  the process when the person is mapped onto a walkingarea (SUMO issue 17257);
* only the striping pedestrian model obeys moveToXY;
* a pending moveToXY at ``close`` crashes the next simulation, so nothing that can raise stands
  between the moves and ``simulationStep``.
"""

from __future__ import annotations

import collections
import contextlib
import itertools
import math
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from giveway.errors import InstallationError, ScenarioError, SumoError
from giveway.lanes import Lanes
from giveway.native_stderr import NativeStderr
from giveway.sumo_command import EGO_TYPE, PEDESTRIAN_TYPE, own_types, sumo_command
from giveway.traffic import NO_VEHICLES, BackgroundVehicles, angle_to_heading, heading_to_angle

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import TracebackType

    from giveway.ego_path import Pose
    from giveway.tracks import VehicleShape

POSITION_TOLERANCE = 1e-6  # [m] between our state and SUMO's after each step
_DEPART_NOW = -3  # libsumo's constant for "in the next step"
_KEEP_ROUTE = 2  # move exactly to x, y, whatever lane is there
_NO_EDGE = itertools.repeat("")
_EXACTLY = itertools.repeat(_KEEP_ROUTE)
_WITHOUT_MATCHING = itertools.repeat(-1.0)  # the "ghost" mode: no lane is sought (issue 17257)


class SumoSession:
    """A running simulation; one per process at a time, closed in every case.

    Args:
        config_file: the scenario's ``.sumocfg``; nothing is written beside it.
        seed: SUMO's random seed.
        step_length: SUMO's step [s]; None keeps the scenario's.
        ego_shape: the ego's body, for SUMO's followers.

    Raises:
        SumoError: SUMO does not load the scenario; the message carries SUMO's reason.
        InstallationError: libsumo cannot be imported.
    """

    _running = False

    def __init__(
        self, config_file: Path, *, seed: int, step_length: float | None, ego_shape: VehicleShape
    ) -> None:
        if SumoSession._running:
            msg = "SUMO: a simulation is already running; libsumo holds one per process, close it"
            raise SumoError(msg)
        self._sumo = _import_libsumo()
        self._config_file = config_file
        self._ego_id = ""
        self._ego_shape = ego_shape
        self._shapes: dict[str, tuple[str, float, float]] = {}
        with tempfile.TemporaryDirectory(prefix="giveway-") as folder:
            types = Path(folder) / "giveway.add.xml"
            types.write_text(own_types(ego_shape), encoding="utf-8")
            command = sumo_command(config_file, types, seed=seed, step_length=step_length)
            self._stderr = NativeStderr()
            try:
                with self._stderr:
                    self._sumo.start(command)
            except Exception as error:
                reason = self._stderr.errors() or str(error)
                self._stderr.close()
                msg = f"{config_file}: SUMO cannot load this scenario: {reason}"
                raise SumoError(msg) from error
        SumoSession._running = True
        # The wrapper's methods only pass their arguments on, which takes as long as a move.
        direct = getattr(self._sumo.libsumo, "_libsumo", None)
        person = self._sumo.person
        self._move_person = getattr(direct, "person_moveToXY", person.moveToXY)
        self._person_position = getattr(direct, "person_getPosition", person.getPosition)
        self.lanes = Lanes(self._sumo, config_file)
        self.step_length = float(self._sumo.simulation.getDeltaT())

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    # --- reading ------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """SUMO's clock [s]."""
        return float(self._sumo.simulation.getTime())

    @property
    def end(self) -> float:
        """The scenario's end [s]; infinite where it names none."""
        end = float(self._sumo.simulation.getEndTime())
        return end if end >= 0.0 else math.inf

    @property
    def version(self) -> str:
        """SUMO's version string."""
        return str(self._sumo.simulation.getVersion()[1])

    @property
    def messages(self) -> str:
        """What SUMO has printed on stderr so far: warnings, mostly."""
        return self._stderr.text()

    def background_vehicles(self) -> BackgroundVehicles:
        """Every vehicle of the scenario except the ego, as of SUMO's clock."""
        vehicle = self._sumo.vehicle
        ids = tuple(sorted(name for name in vehicle.getIDList() if name != self._ego_id))
        if not ids:
            return NO_VEHICLES
        for name in ids:
            if name not in self._shapes:
                size = vehicle.getLength(name), vehicle.getWidth(name)
                self._shapes[name] = (vehicle.getTypeID(name), *size)
        rows = np.array(
            [
                (
                    *vehicle.getPosition(name),
                    angle_to_heading(vehicle.getAngle(name)),
                    vehicle.getSpeed(name),
                    *self._shapes[name][1:],
                )
                for name in ids
            ],
            dtype=np.float64,
        ).reshape(-1, 6)
        types = tuple(self._shapes[name][0] for name in ids)
        return BackgroundVehicles(ids, types, *np.ascontiguousarray(rows.T))

    # --- adding and removing ------------------------------------------------------------------

    def run_until(self, time: float) -> None:
        """Let the scenario run by itself up to ``time`` [s]."""
        while self.time < time - 1e-9:
            self._step()

    def add_ego(
        self, ego_id: str, edges: Sequence[str], *, lane: int, position: float, speed: float
    ) -> None:
        """Insert the ego; it appears with the next :meth:`mirror`.

        The speed is the FMU's business: SUMO only hears as much of it as the lane permits.
        """
        if ego_id in self._sumo.vehicle.getIDList():
            msg = f"ego id '{ego_id}': the scenario already has this vehicle; choose another id"
            raise ScenarioError(msg)
        route = f"giveway_route_{ego_id}"
        self._call(self._sumo.route.add, route, list(edges))
        self._call(
            self._sumo.vehicle.add,
            ego_id,
            route,
            typeID=EGO_TYPE,
            depart="now",
            departPos=f"{position:.3f}",
            departSpeed=f"{min(speed, self._sumo.lane.getMaxSpeed(f'{edges[0]}_{lane}')):.3f}",
        )
        self._ego_id = ego_id

    def add_persons(self, ids: Sequence[str], host_edge: str) -> None:
        """Add persons who live on ``host_edge``; they appear with the next :meth:`mirror`."""
        if host_edge not in self._sumo.edge.getIDList():
            msg = (
                f"{self._config_file}: host edge '{host_edge}' for the pedestrians does not exist; "
                "name an edge that allows pedestrians with [crowd] host_edge"
            )
            raise ScenarioError(msg)
        taken = set(self._sumo.person.getIDList()).intersection(ids)
        if taken:
            msg = f"person id '{min(taken)}': the scenario already has this person"
            raise ScenarioError(msg)
        for name in ids:
            self._call(self._sumo.person.add, name, host_edge, 0.0, _DEPART_NOW, PEDESTRIAN_TYPE)
            self._call(self._sumo.person.appendWalkingStage, name, [host_edge], -1.0)

    def remove_persons(self, ids: Sequence[str]) -> None:
        """Let persons arrive; they are gone with the next step."""
        for name in ids:
            self._call(self._sumo.person.removeStages, name)  # unlike remove: counts as arrival

    # --- stepping -----------------------------------------------------------------------------

    def mirror(
        self,
        ego: Pose | None,
        ids: Sequence[str],
        x: Sequence[float],
        y: Sequence[float],
        angles: Sequence[float],
    ) -> None:
        """Move ego and persons, make one SUMO step, and check that SUMO stands where we do.

        Args:
            ego: the front bumper's pose after the step.
            ids: the persons' ids.
            x: of each person [m], finite.
            y: of each person [m], finite.
            angles: of each person [deg, 0 = north, clockwise], finite.

        Raises:
            SumoError: SUMO failed, or disagrees by more than 1e-6 m.
        """
        try:
            with self._stderr:
                if ego is not None:
                    angle = heading_to_angle(ego.heading)
                    self._sumo.vehicle.moveToXY(
                        self._ego_id, "", -1, ego.x, ego.y, angle, _KEEP_ROUTE
                    )
                moves = map(
                    self._move_person, ids, _NO_EDGE, x, y, angles, _EXACTLY, _WITHOUT_MATCHING
                )
                collections.deque(moves, maxlen=0)  # the fastest loop that Python has
                self._sumo.simulationStep()
        except Exception as error:
            raise self._failure(error) from error
        self._check(ego, ids, list(zip(x, y, strict=True)))

    def _check(
        self, ego: Pose | None, ids: Sequence[str], points: list[tuple[float, float]]
    ) -> None:
        try:
            if ego is not None:
                there = self._sumo.vehicle.getPosition(self._ego_id)
                _compare("vehicle", self._ego_id, there, ego, self.time)
            mirrored = list(map(self._person_position, ids))
        except self._sumo.TraCIException as error:
            raise self._failure(error) from error
        if mirrored != points:  # as a rule they are the same to the bit
            for name, there, here in zip(ids, mirrored, points, strict=True):
                _compare("person", name, there, here, self.time)

    def _step(self) -> None:
        self._call(self._sumo.simulationStep)

    def _call(self, function: Any, *arguments: Any, **keywords: Any) -> Any:
        """A libsumo call whose failure becomes a :class:`SumoError` with SUMO's own reason."""
        try:
            with self._stderr:
                return function(*arguments, **keywords)
        except Exception as error:
            raise self._failure(error) from error

    def _failure(self, error: Exception) -> SumoError:
        reasons = [part for part in (str(error).strip(), self._stderr.errors()) if part]
        reason = "; ".join(dict.fromkeys(reasons)) or type(error).__name__
        return SumoError(f"{self._config_file}: SUMO failed at {self.time:.3f} s: {reason}")

    def close(self) -> None:
        """End the simulation; harmless when repeated."""
        if not SumoSession._running:
            return
        SumoSession._running = False
        with self._stderr:
            with contextlib.suppress(Exception):  # the simulation is being given up anyway
                self._sumo.simulationStep()  # carries out pending moves, which close() would leak
            self._sumo.close()
        self._stderr.close()


def _compare(
    kind: str, name: str, there: tuple[float, float], here: Sequence[float], time: float
) -> None:
    deviation = math.hypot(there[0] - here[0], there[1] - here[1])
    if deviation > POSITION_TOLERANCE:
        msg = (
            f"{kind} '{name}' at {time:.3f} s: SUMO has it {deviation:.3g} m away from our state; "
            f"expected at most {POSITION_TOLERANCE:g} m; is it moved by somebody else?"
        )
        raise SumoError(msg)


def _import_libsumo() -> Any:
    try:
        import libsumo
    except ImportError as error:
        msg = f"libsumo cannot be imported ({error}); reinstall with: pip install giveway"
        raise InstallationError(msg) from error
    return libsumo
