"""The master loop: vehicle FMUs, controllers, crowd and SUMO, one control step after the other.

The order of one step, from t_k to t_k+1 (Yang & Özgüner 2019, algorithm 1):

1. where SUMO has just stepped, read it: egos that depart, people who come in or change the zone,
   lights, people's priority, background vehicles and the pedestrians they yield to;
2. for each ego: predict the crowd, solve for the force u(k);
3. record the state at t_k and u(k);
4. step the vehicles and the crowd, both from the state at t_k, so that their order is irrelevant;
5. where SUMO's step ends at t_k+1: move everybody there, step SUMO, compare.

All that may raise an error comes before the moves of step 5. The controller is called between
reading and stepping the FMU, without a lag of one sample: position and speed do not depend on
the force instantaneously, so there is no algebraic loop.
"""

from time import perf_counter

import numpy as np

from controller import ControllerError
from fmus import FmuError
from giveway.cosimulation.assembly import Parts
from giveway.cosimulation.counterfactual.follow_up import Followed
from giveway.cosimulation.law_records import LawRecords
from giveway.cosimulation.mirror import Mirror
from giveway.cosimulation.recording_instants import Instants
from giveway.cosimulation.standstill import Standstill
from giveway.cosimulation.traffic.interactions import Meetings
from giveway.cosimulation.world import World
from giveway.crowd.reachable import flow_remark, spawn_remark, way_of
from giveway.crowd.roster import Walking
from giveway.ego.ego import Ego
from giveway.errors import ControlError, CrowdError, RuleError, SensorError, VehicleError
from giveway.geometry.kernel import Array
from giveway.journal.recorder import Recorder
from giveway.processes.garbage import full_collections_put_off
from giveway.processes.heartbeat import INSTANT, MILLISECONDS, PHASE, Phase
from giveway.processes.interrupts import DeferredInterrupt
from giveway.run_data.progress import Ending, Progress, Watcher
from pedestrian_model import PedestrianModelError, PlugInError

_CONTROLLING, _VEHICLE = Phase.CONTROLLING, Phase.VEHICLE
_CROWD, _SUMO = Phase.CROWD, Phase.SUMO


class Loop:
    """The state of one run, and its steps.

    Args:
        parts: Parts of the run, at their initial state.
        recorder: Recorder that gathers the rows.
        follow: True to note how people and traffic get on, for :meth:`follow_up`.

    Attributes:
        endings: Ending of each ego that has left the road or was on it when the run ended.
        remarks: Remarks on how the run went, one sentence each.
        followed: Notes for :meth:`follow_up`, or None without ``follow``.
    """

    def __init__(self, parts: Parts, recorder: Recorder, *, follow: bool = False) -> None:
        self._parts = parts
        self._recorder = recorder
        self._law = LawRecords(parts.sumo, recorder)
        heartbeat = recorder.journal.heartbeat
        self._pulse, self._instant = heartbeat.slots, heartbeat.instant
        self._start = parts.sumo.time
        self._time_step = parts.time_step
        self._k = 0
        self._roster = parts.roster
        self._egos: list[Ego] = []
        self._ways: list[Array] = []  # (k, 2) [m] driven path of each ego that has departed
        self.endings: dict[str, Ending] = {}
        self.remarks: list[str] = []
        self._standstill = Standstill()
        self._mirror = Mirror(parts.sumo, parts.time_step, parts.substeps, parts.horizon)
        self.meetings = Meetings(parts.sumo, parts.yielding, parts.gaps)
        self._instants = Instants(recorder, parts.config.record, parts.time_step)
        self._fronts = np.empty((0, 2))
        self.world = World(parts, self._mirror)
        self.followed = Followed(parts) if follow else None
        walks = None if self.followed is None else self.followed.walks
        self._walking = Walking(parts.config, parts.crowd_model, parts.roster, walks)

    def run(self, watcher: Watcher | None, interrupt: DeferredInterrupt) -> Ending:
        """Step until every ego has arrived, a limit is reached or the user interrupts.

        Raises:
            GivewayError: a part failed; everything recorded so far stays recorded.
        """
        try:
            with full_collections_put_off():
                ending = self._run(watcher, interrupt)
        except FmuError as error:
            raise VehicleError(f"step {self._k}: {error}") from error
        except ControllerError as error:
            raise ControlError(f"controller at step {self._k}: {error}") from error
        except RuleError as error:
            raise RuleError(f"rule at step {self._k}: {error}") from error
        except SensorError as error:
            raise SensorError(f"sensor at step {self._k}: {error}") from error
        except PedestrianModelError as error:
            raise CrowdError(self._blame(error)) from error
        for ego in self._egos:
            self.endings.setdefault(ego.id, ending)
            self._remark_on_rules(ego)
        if ending in {Ending.SCENARIO_END, Ending.TIME_LIMIT}:
            self._parts.departures.require_all()
        return ending

    def follow_up(self, ending: Ending, interrupt: DeferredInterrupt) -> bool:
        """Go on without egos until the people who came close have arrived; no row is recorded.

        Args:
            ending: Ending of the run.
            interrupt: Flag that is read between two steps.

        Returns:
            True if it came to its end without an interrupt.

        Raises:
            GivewayError: a part failed.
        """
        if self.followed is None:
            return False
        return self.followed.follow(
            ending is Ending.COMPLETED,
            self._walking,
            self._mirror,
            self._k,
            self._start,
            self._recorder.journal.heartbeat,
            interrupt,
        )

    def _blame(self, error: PedestrianModelError) -> str:
        """Name the pedestrian whose state is not finite by their id."""
        crowd, roster = self._roster.crowd, self._roster
        if isinstance(error, PlugInError):
            whom = "" if error.person is None else f"pedestrian '{roster.names[error.person]}': "
            return f"crowd at step {self._k}: {whom}{error}"
        state = np.concatenate([crowd.position, crowd.velocity], axis=1)
        bad = np.flatnonzero(~np.isfinite(state).all(axis=1))
        if not len(bad):
            return f"crowd at step {self._k}: {error}"
        name = roster.ids[roster.person_ids[bad[0]]]
        return (
            f"pedestrian '{name}' at step {self._k}: position and velocity "
            f"{state[bad[0]].tolist()}; expected finite numbers [m, m/s]"
        )

    def _run(self, watcher: Watcher | None, interrupt: DeferredInterrupt) -> Ending:
        parts = self._parts
        limit = np.inf if parts.config.time_limit is None else parts.config.time_limit
        last_step = min(limit, parts.sumo.end - self._start) / self._time_step - 1e-6
        while True:
            self._began = perf_counter()
            if self._k % parts.substeps == 0:
                self._read_sumo()
            self._read_at = perf_counter()
            acting = self._control()
            if watcher is not None:
                watcher(self._progress(acting))
            self._see_arrivals()
            if parts.egos and not self._egos and not parts.departures.waiting:
                return Ending.COMPLETED
            if self._k >= last_step:
                over = limit / self._time_step - 1e-6 <= self._k
                return Ending.TIME_LIMIT if over else Ending.SCENARIO_END
            if not self._egos and self._nobody_comes():
                return Ending.SCENARIO_END
            elapsed = self._k * self._time_step
            if parts.sumo.end == np.inf and self._standstill.too_long(self._egos, elapsed):
                self.remarks.append(self._standstill.remark)
                return Ending.TIME_LIMIT
            if interrupt.requested:
                return Ending.INTERRUPTED
            self._advance()

    def _nobody_comes(self) -> bool:
        """Return whether a scenario without an end is empty, and no ego is to be inserted."""
        sumo, waiting = self._parts.sumo, self._parts.departures.waiting
        if sumo.end < np.inf or sumo.expects_more or not all(ego.taken_over for ego in waiting):
            return False
        return self._parts.arrivals is None or not self._parts.arrivals.sources.keeps_coming

    def _progress(self, acting: str) -> Progress:
        elapsed, pedestrians = self._k * self._time_step, len(self._roster)
        clock = self._start + elapsed
        if not self._egos:
            return Progress(elapsed, clock, np.nan, np.nan, np.nan, acting, pedestrians)
        ego = self._egos[0]
        position, speed = ego.vehicle.position, ego.vehicle.speed
        return Progress(elapsed, clock, position, ego.goal, speed, acting, pedestrians)

    # --- step 1 -------------------------------------------------------------------------------

    def _read_sumo(self) -> None:
        parts = self._parts
        clock = self._start + self._k * self._time_step
        if parts.departures.waiting:
            arrivals = parts.departures.due()
            self._egos += arrivals
            for ego in arrivals:
                self._recorder.drive(ego.id, ego.shape, ego.goal)
                self._law.depart(parts.departures.ways[ego.id])
                end = ego.departure + ego.goal
                self._ways.append(way_of(ego.path.vertices, ego.path.stations, ego.departure, end))
                if self.followed is not None:
                    self.followed.walks.add_way(self._ways[-1])
            if arrivals and not parts.departures.waiting:
                self._remark_on_far_people()
        if parts.arrivals is not None:
            parts.arrivals.update(self._k)
        if parts.exchange is not None:
            parts.exchange.update(self._places())
        if parts.priority is not None:
            parts.priority.update(self._roster.crowd)
        self._mirror.read(self._egos, self._roster.crowd.position)
        if self._law.ruled:
            self._law.signals(clock)
        background, meetings = self._mirror.background, self.meetings
        meetings.let_cross(background, self._egos)
        if background.ids or meetings.pending or any(ego.watches for ego in self._egos):
            meetings.update(background, self._roster, self._egos)
            self._mirror.mark_beside(self._egos)
        if self.followed is not None:
            self.followed.traffic.note(background)
        if background.ids:
            self._instants.background(self._k, clock, background, self._places())
        self._recorder.ledger(self._roster.ledger)

    def _remark_on_far_people(self) -> None:
        """Add a remark if the added pedestrians walk where no ego comes by."""
        crowd = self._parts.config.crowd
        remarks = [flow_remark(crowd.flow, self._ways)]
        if crowd.pedestrians:
            remarks.append(spawn_remark(crowd, self._ways, self._parts.net_file))
        self.remarks += [remark for remark in remarks if remark]

    def _remark_on_rules(self, ego: Ego) -> None:
        self.remarks += [f"ego '{ego.id}': {said}" for said in ego.rules.remarks]

    def _places(self) -> Array:
        """The egos' front bumpers (e, 2) [m]."""
        if len(self._fronts) != len(self._egos):
            self._fronts = np.empty((len(self._egos), 2))
        for row, ego in enumerate(self._egos):
            self._fronts[row, 0], self._fronts[row, 1], _ = ego.pose
        return self._fronts

    # --- steps 2 and 3 ------------------------------------------------------------------------

    def _control(self) -> str:
        """Decide on every ego's force, and record the instant."""
        time = self._start + self._k * self._time_step
        instant, pulse = self._instant, self._pulse
        instant[0], instant[1] = self._k, round(time * MILLISECONDS)
        pulse[INSTANT] = instant
        pulse[PHASE] = _CONTROLLING
        recorder, mirror = self._recorder, self._mirror
        recorder.instant(time)
        mirror.place(self._egos)
        truth, surroundings = self.world.at(time, self._egos), self._parts.surroundings
        predicting = controlling = 0.0
        acting = ""
        for row, ego in enumerate(self._egos):
            look_at = perf_counter()
            seen = ego.look(row, mirror.poses, truth, surroundings, self._roster.person_ids)
            decide_at = perf_counter()
            decision = ego.decide(self._k, time, seen)
            controlled_at = perf_counter()
            recorder.ego(ego.id, ego.row(time, seen, decision))
            if len(seen.sudden_starts):
                recorder.hasty(ego.id, seen.sudden_starts)
            if len(seen.sights):
                recorder.sights(time, ego.id, seen.sights)
            if ego.has_outputs:
                recorder.outputs(ego.id, *ego.outputs())
            predicted = ego.expected(seen) if self._instants.looks else None
            if predicted is not None:
                whom, relevant = seen.ids, seen.relevant
                whom = whom if relevant is None else whom[relevant]
                self._instants.predictions(ego.id, predicted, whom)
            predicting += decide_at - look_at
            controlling += controlled_at - decide_at
            acting = acting or decision.acting
        roster = self._roster
        self._instants.crowd(self._k, roster, self._places(), everybody=not self._parts.egos)
        if self._law.ruled:
            self._law.walks(roster)
        self._walking.note(self._k)
        recorder.journal.commit()
        self._predicting, self._controlling = predicting, controlling
        return acting

    # --- steps 4 and 5 ------------------------------------------------------------------------

    def _see_arrivals(self) -> None:
        """Let the egos that have driven their distance leave the road."""
        gone = [ego for ego in self._egos if ego.arrived]
        for ego in gone:
            self.endings[ego.id] = Ending.COMPLETED
            self._remark_on_rules(ego)
            self._mirror.drop(self._egos.index(ego))
            self._egos.remove(ego)
            if self._egos or self._parts.departures.waiting:
                self._parts.sumo.vehicles.dismiss(ego.id)
        if gone and self.followed is not None:
            self.followed.leave(gone, dismissed=bool(self._egos or self._parts.departures.waiting))

    def _advance(self) -> None:
        parts, mirror = self._parts, self._mirror
        recorded_at = perf_counter()
        self._pulse[PHASE] = _VEHICLE
        for ego in self._egos:
            ego.advance()
        vehicle_at = perf_counter()
        self._pulse[PHASE] = _CROWD
        self._step_crowd()
        crowd_at = perf_counter()
        self._k += 1
        self._pulse[PHASE] = _SUMO
        if self._k % parts.substeps:
            mirror.carry_on()
        else:
            mirror.push(self._k, self._egos, self._roster)
            if parts.departures.waiting:
                parts.departures.note()
        ended = perf_counter()
        self._recorder.timing(
            self._predicting,
            self._controlling,
            vehicle_at - recorded_at,
            crowd_at - vehicle_at,
            ended - crowd_at + self._read_at - self._began,
            ended - self._began,
        )

    def _step_crowd(self) -> None:
        """Move the crowd under the vehicles at t_k, and remove the pedestrians who have arrived."""
        parts = self._parts
        names = self._walking.advance(self._k, self._mirror.vehicles, parts.surroundings)
        if names:  # they leave SUMO with its next step
            ours = names if parts.exchange is None else parts.exchange.arrive(names)
            parts.sumo.remove_persons(ours)
            parts.roster.count("arrived", len(ours))
