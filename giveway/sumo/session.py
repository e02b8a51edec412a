"""The running simulation: the only object that owns libsumo.

SUMO is synchronised to giveway's state: egos and pedestrians are moved to the positions that the
vehicle FMU and the VCI model give, and giveway's state is exported. These rules for the moves were
found by experiment on SUMO 1.28:

* a person follows ``moveToXY(..., keepRoute=2, matchThreshold=-1)`` exactly; other arguments kill
  the process when the person is mapped onto a walkingarea (SUMO issue 17257);
* only the striping pedestrian model obeys moveToXY;
* a pending moveToXY at ``close`` crashes the next simulation, so nothing that can raise an error
  stands between the moves and ``simulationStep``.
"""

import contextlib
import math
from collections.abc import Container, Iterable, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any, Self

from giveway.errors import ScenarioError, SumoError
from giveway.geometry.path import Pose, heading_to_angle
from giveway.scenario_files import ScenarioFiles, StartOptions, prepare_start
from giveway.scenario_files.outputs import is_file
from giveway.sumo.devices import Devices
from giveway.sumo.first_reading import read_first
from giveway.sumo.library import direct, import_libsumo
from giveway.sumo.light_requests import LightRequests
from giveway.sumo.network.footpaths import FootPaths
from giveway.sumo.network.junction_links import Junctions
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.network.soundness import require_sound
from giveway.sumo.opaque_bodies import OpaqueBodies
from giveway.sumo.persons.handover import NOWHERE
from giveway.sumo.persons.person_moves import PersonMoves
from giveway.sumo.persons.scenario_persons import ScenarioPersons
from giveway.sumo.scratch import scratch
from giveway.sumo.signal_plans import SignalPlans
from giveway.sumo.stderr import NativeStderr, of_others
from giveway.sumo.types import PEDESTRIAN_TYPE
from giveway.sumo.vehicles import SumoVehicles

# Largest difference [m] between giveway's positions and SUMO's after each step
POSITION_TOLERANCE = 1e-6
_DEPART_NOW = -3  # libsumo's constant for "in the next step"
_EXACT = 2  # libsumo's flag for a move exactly to x, y, independently of lanes
_ON_ROUTE = 1  # its flag for a move that keeps the route, which SUMO may replace without it


class SumoSession:
    """A running simulation. A process can have one at a time, and it is closed even after errors.

    Args:
        scenario: Files of the scenario; nothing is written beside them.
        options: Options for SUMO's start.
        types: Text of an additional file with the types of all that giveway is going to add.
        native_log: File for the output of SUMO, or None for a temporary one.
        careful: True to let a child process read the scenario first, so that a crash of SUMO
            does not end this process.

    Raises:
        ScenarioError: an input file is missing or cannot be read.
        SumoError: SUMO does not load the scenario; the message carries SUMO's reason.
        InstallationError: libsumo cannot be imported.
    """

    _running = False

    def __init__(
        self,
        scenario: ScenarioFiles,
        options: StartOptions,
        types: str,
        *,
        native_log: Path | None = None,
        careful: bool = False,
    ) -> None:
        if SumoSession._running:
            raise SumoError(
                "SUMO: a simulation is already running; libsumo holds one per process, close it"
            )
        self._sumo = import_libsumo()
        self._config_file = scenario.config_file
        self._native_log = native_log
        self._extra = options.extra
        self._scratch = scratch()
        try:
            self.start = prepare_start(scenario, options, Path(self._scratch.name), types=types)
            if careful and not _calls_somebody(scenario):
                read_first(self._config_file, self.start.command, self.start.read)
            self._load()
        except BaseException:
            self._scratch.cleanup()
            raise
        SumoSession._running = True
        self._step = direct(self._sumo, "simulation", "step")
        self._person_moves = PersonMoves(self._sumo)
        self._move_vehicle = direct(self._sumo, "vehicle", "moveToXY")
        self._vehicle_position = direct(self._sumo, "vehicle", "getPosition")
        self._light_state = direct(self._sumo, "trafficlight", "getRedYellowGreenState")
        self.signal_plans = SignalPlans(self._sumo)
        self._moves_pending = False
        self.lanes = Lanes(self._sumo, self._config_file, scenario.net_file)
        self.junctions = Junctions(self._sumo, scenario.net_file, self.lanes)
        self.devices = Devices(self._sumo)
        self.light_requests = LightRequests(self._sumo)
        self.vehicles = SumoVehicles(self._sumo, self.call, self.lanes)
        self.opaque = OpaqueBodies(self._sumo)
        self.step_length = float(self._sumo.simulation.getDeltaT())
        self._persons: ScenarioPersons | None = None
        self._added: set[str] = set()
        # for each object just added: time [s] of the addition, and its lane
        self._just_added: dict[str, tuple[float, str | None]] = {}
        self._host_lanes: dict[str, str | None] = {}  # host lanes by edge

    def _load(self) -> None:
        self._stderr = NativeStderr(self._native_log)
        try:
            with self._stderr:
                self._sumo.start(list(self.start.command))
        except Exception as error:
            reason = self._readable(self._stderr.errors() or str(error))
            self._stderr.close()
            msg = f"{self._config_file}: SUMO cannot load this scenario: {reason}"
            if self._extra:
                msg += f" (with --sumo-options '{' '.join(self._extra)}')"
            raise SumoError(msg) from error
        try:
            require_sound(self._sumo, self._config_file)
        except ScenarioError:
            with self._stderr:
                self._sumo.close()
            self._stderr.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # --- reading ------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """The time on SUMO's clock [s]."""
        return float(self._sumo.simulation.getTime())

    @cached_property
    def end(self) -> float:
        """The scenario's end [s], or infinity if it names none."""
        end = float(self._sumo.simulation.getEndTime())
        return end if end >= 0.0 else math.inf

    @property
    def version(self) -> str:
        """The version text of SUMO."""
        return str(self._sumo.simulation.getVersion()[1])

    @property
    def messages(self) -> str:
        """The output of SUMO on stderr so far, mostly warnings."""
        held = set() if self._persons is None else self._persons.ever_held
        return of_others(self._stderr.text(), self._added | held)

    @property
    def hushed(self) -> NativeStderr:
        """A context in which the output of SUMO goes to the log instead of the terminal."""
        return self._stderr

    @property
    def expects_more(self) -> bool:
        """True if vehicles or persons are on the way or have yet to depart."""
        return bool(self._sumo.simulation.getMinExpectedNumber() > 0)

    def light_state(self, system: str) -> str:
        """Return the state of a traffic light, one letter per movement."""
        return str(self._light_state(system))

    def light_states(self, systems: Iterable[str]) -> dict[str, str]:
        """Return the state of each of these traffic lights, one letter per movement."""
        return {system: self.light_state(system) for system in systems}

    @cached_property
    def light_systems(self) -> tuple[str, ...]:
        """The ids of all traffic lights in SUMO."""
        return tuple(self._sumo.trafficlight.getIDList())

    def persons(self, added: Container[str]) -> ScenarioPersons:
        """Return the scenario's own persons, which can be taken over and handed back.

        Args:
            added: Ids of persons that giveway added, which are never touched.
        """
        self._persons = ScenarioPersons(self._sumo, added)
        self._person_moves.onto = self._persons.records.moves
        return self._persons

    # --- adding and removing ------------------------------------------------------------------

    def add_persons(self, ids: Sequence[str], host_edge: str) -> None:
        """Add persons on ``host_edge``. They appear with the next :meth:`mirror`."""
        if host_edge not in self._host_lanes:
            self._host_lanes[host_edge] = self._host_lane(host_edge)
        taken = set(self._sumo.person.getIDList()).intersection(ids)
        if taken:
            raise ScenarioError(f"person id '{min(taken)}': the scenario already has this person")
        for name in ids:
            self.call(self._sumo.person.add, name, host_edge, 0.0, _DEPART_NOW, PEDESTRIAN_TYPE)
            self.call(self._sumo.person.appendWalkingStage, name, [host_edge], -1.0)
            self._just_added[name] = self.time, self._host_lanes[host_edge]
        self._added.update(ids)

    def _host_lane(self, host_edge: str) -> str | None:
        if host_edge not in self._sumo.edge.getIDList():
            raise ScenarioError(
                f"{self._config_file}: host edge '{host_edge}' for the pedestrians does not exist; "
                "name an edge that allows pedestrians with [crowd] host_edge"
            )
        return FootPaths(self._sumo).lane(host_edge)

    def remove_persons(self, ids: Sequence[str]) -> None:
        """Let persons arrive. They leave SUMO with the next step."""
        for name in ids:
            self._just_added.pop(name, None)
            self.call(self._sumo.person.removeStages, name)  # counts as an arrival, unlike `remove`

    def _clear_host_edges(self) -> None:
        """Move departed persons away from the beginning of their host edge in SUMO's records.

        SUMO's own pedestrians would walk round persons that seem to stand there.
        """
        now = self.time
        for name, (added_at, lane) in list(self._just_added.items()):
            if now > added_at:
                del self._just_added[name]
                if lane is not None:
                    self.call(self._sumo.person.moveTo, name, lane, NOWHERE)

    # --- stepping -----------------------------------------------------------------------------

    def mirror(
        self,
        egos: Sequence[tuple[str, Pose]],
        ids: Sequence[str],
        x: Sequence[float],
        y: Sequence[float],
        angles: Sequence[float],
    ) -> None:
        """Move egos and persons, make one SUMO step, and compare SUMO's positions with giveway's.

        Args:
            egos: Id of each ego, and pose of its front bumper after the step.
            ids: Ids of the persons.
            x: Coordinate x of each person [m], finite.
            y: Coordinate y of each person [m], finite.
            angles: Angles of each person [deg, 0 = north, clockwise], finite.

        Raises:
            SumoError: SUMO failed, or a position differs by more than 1e-6 m.
        """
        if self._just_added:
            self._clear_host_edges()
        self._moves_pending = bool(egos or ids)
        try:
            with self._stderr:
                for name, pose in egos:
                    angle = heading_to_angle(pose.heading)
                    self._move_vehicle(name, "", -1, pose.x, pose.y, angle, _EXACT | _ON_ROUTE)
                self._person_moves.make(ids, x, y, angles)
                self._step()
                self._moves_pending = False
        except Exception as error:
            raise self._failure(error) from error
        self._check(egos, ids, x, y)

    def _check(
        self,
        egos: Sequence[tuple[str, Pose]],
        ids: Sequence[str],
        x: Sequence[float],
        y: Sequence[float],
    ) -> None:
        try:
            for name, pose in egos:
                there = self._vehicle_position(name)
                if there != pose[:2]:
                    self._compare("vehicle", name, there, pose)
            self._person_moves.compare(ids, x, y, partial(self._compare, "person"))
        except self._sumo.TraCIException as error:
            raise self._failure(error) from error

    def _compare(
        self, kind: str, name: str, there: tuple[float, float], here: Sequence[float]
    ) -> None:
        deviation = math.hypot(there[0] - here[0], there[1] - here[1])
        if deviation > POSITION_TOLERANCE:
            raise SumoError(
                f"{kind} '{name}' at {self.time:.3f} s: SUMO has it {deviation:.3g} m away from "
                f"our state; expected at most {POSITION_TOLERANCE:g} m; is it moved by somebody "
                "else?"
            )

    def step(self) -> None:
        """Let the scenario go on by itself for one SUMO step."""
        self.call(self._step)

    def call(self, function: Any, *arguments: Any, **keywords: Any) -> Any:
        """Call libsumo; a failure becomes a :class:`SumoError` with SUMO's own reason."""
        try:
            with self._stderr:
                return function(*arguments, **keywords)
        except Exception as error:
            raise self._failure(error) from error

    def _failure(self, error: Exception) -> SumoError:
        reasons = [part for part in (str(error).strip(), self._stderr.errors()) if part]
        reason = "; ".join(dict.fromkeys(reasons)) or type(error).__name__
        reason = self._readable(reason)
        return SumoError(f"{self._config_file}: SUMO failed at {self.time:.3f} s: {reason}")

    def _readable(self, reason: str) -> str:
        """SUMO's reason on one line, with the scenario's own files instead of our copies."""
        return " ".join(self.start.with_original_names(reason).split())

    def close(self) -> None:
        """End the simulation; a second call does nothing."""
        if not SumoSession._running:
            return
        SumoSession._running = False
        with self._stderr:
            if self._moves_pending:  # a step without pending moves would only add to SUMO's outputs
                with contextlib.suppress(Exception):  # the simulation is being closed anyway
                    # carries out the pending moves, which would crash the next simulation
                    self._step()
            self._sumo.close()
        self._stderr.close()
        with contextlib.suppress(OSError):
            self._scratch.cleanup()


def _calls_somebody(scenario: ScenarioFiles) -> bool:
    """Return whether an output goes to a network address."""
    names = [name for files in scenario.outputs.values() for name in files]
    return any(":" in name and not is_file(name) for name in names)
