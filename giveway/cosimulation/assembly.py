"""Assembles the parts of a run from its configuration, each at its initial state."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import shapely
from shapely.ops import substring

from giveway.config import EgoRunConfig, RunConfig
from giveway.cosimulation.entry.departures import Departures
from giveway.cosimulation.people.arrivals import Arrivals
from giveway.cosimulation.people.initial import people_at_first, people_to_come
from giveway.cosimulation.preflight import CheckedRun, substeps_of
from giveway.cosimulation.traffic.swept import swept_near
from giveway.cosimulation.traffic.yielding import Yielding
from giveway.crowd.exchange import Exchange
from giveway.crowd.gap_acceptance import GapAcceptance
from giveway.crowd.models import model_of
from giveway.crowd.motion.at_kerb import HeldAtKerb
from giveway.crowd.priority import PriorityOnFoot
from giveway.crowd.roster import Roster
from giveway.crowd.zone import Zone
from giveway.ego.controllers import make_controller
from giveway.ego.preparation import make_waiting_ego, recorded_ego
from giveway.ego.vehicle import model_remark
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import BODY, VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.run_data.tracks import EgoTrack
from giveway.scenario_files import StartOptions
from giveway.sumo.session import SumoSession
from giveway.sumo.types import all_types, inserted_type
from giveway.walkways import WalkNetwork
from pedestrian_model import (
    OPEN_GROUND,
    PedestrianModel,
    Surroundings,
)
from sumo_scenarios import available


class Driven(NamedTuple):
    """The recorded drives of the egos of a run."""

    tracks: Mapping[str, EgoTrack]  # Track of each ego, by its id
    horizon: int  # Prediction horizon of the run [steps]
    start: float  # Time [s] on SUMO's clock at the run's first control step
    absent: bool = False  # True: the egos are left out of the repeated run


@dataclass(frozen=True)
class Parts:
    """The parts of a run."""

    config: RunConfig
    sumo: SumoSession
    time_step: float  # Control step [s]
    substeps: int  # control steps per SUMO step
    horizon: int  # Longest prediction horizon of any ego [steps]
    egos: tuple[WaitingEgo, ...]  # Egos before their departure
    departures: Departures
    roster: Roster
    arrivals: Arrivals | None  # None if nobody comes in during the run
    crowd_model: PedestrianModel
    exchange: Exchange | None  # None if the scenario's own pedestrians stay SUMO's
    surroundings: Surroundings
    yielding: Yielding | None  # None if background vehicles do not yield to pedestrians
    priority: PriorityOnFoot | None  # None if no pedestrian relies on priority
    net_file: Path  # Network file of the scenario
    secluded: bool  # True: only the egos and the added people are ever there
    remarks: tuple[str, ...]  # Remarks for the user

    @property
    def gaps(self) -> GapAcceptance | None:
        """The people at crossings where vehicles have priority, or None without such a crossing."""
        return None if self.exchange is None else self.exchange.gaps

    @property
    def all_remarks(self) -> tuple[str, ...]:
        """The remarks for the user, with those that came up during the run."""
        remarks = list(self.departures.remarks)
        identified = [model_remark(ego.config, self.time_step) for ego in self.egos]
        remarks += [text for text in identified if text]
        remarks += [f"ego '{ego.id}': {text}" for ego in self.egos for text in ego.warnings]
        remarks += [] if self.arrivals is None else self.arrivals.sources.remarks
        unconnected = 0 if self.exchange is None else self.exchange.unconnected
        if unconnected:
            remarks.append(
                f"walkers: {unconnected} hop(s) of their routes lead where the network has no "
                "walkway; they take the straight line"
            )
        return (*self.remarks, *remarks)


def assemble(
    checked: CheckedRun,
    stack: ExitStack,
    *,
    outputs: Path | None = None,
    native_log: Path | None = None,
    goes_on: Callable[[float], bool] = lambda _: True,
    driven: Driven | None = None,
) -> Parts:
    """Set up every part and let SUMO run up to the first departure; ``stack`` closes everything.

    SUMO comes before the vehicles, so that an error of the scenario is reported before any FMU
    runs.

    Args:
        checked: Checked configuration of the run.
        stack: Stack that closes SUMO and the FMUs.
        outputs: Folder for SUMO's own outputs, or None to drop them.
        native_log: File for what SUMO prints, or None for a temporary one.
        goes_on: Function that is called with SUMO's clock [s] at each step until the first
            departure. The run ends when it returns False.
        driven: Drives of the egos in a run that is to be repeated without FMUs and controllers, or
            None if FMUs and controllers drive.

    Raises:
        GivewayError: a part cannot be set up as asked.
    """
    config, files, zone = checked.config, checked.files, checked.zone
    egos, time_step = checked.egos, checked.time_step
    controllers = [make_controller(ego, time_step) for ego in egos if driven is None]
    imagined = config.ego.route if config.ego.none else ()
    walkers = not zone.nowhere and not (zone.follows_egos and not egos and not imagined)
    added = config.crowd.adds_people
    moved = bool(egos) or added or walkers
    sumo = stack.enter_context(
        SumoSession(
            files,
            start_options(config, moved, outputs),
            types_of(egos),
            native_log=native_log,
            careful=driven is None and config.scenario not in available(),
        )
    )
    substeps = substeps_of(time_step, sumo.step_length)
    remarks = list(sumo.start.remarks)
    way = _imagined_way(config, sumo) if imagined else None
    if way is not None:
        zone = zone.along(_driven_part(way, config))
    lit = bool(config.crowd.flow) and any(crossing.system for crossing in sumo.lanes.crossings)
    network = WalkNetwork.read(files.net_file) if walkers or lit or config.crowd.walls else None
    if network is not None:
        zone.require_overlap(network.boundary)
        remarks += _remarks_on(network, files.net_file)
    if driven is None:
        waiting = tuple(
            make_waiting_ego(ego, controller, time_step, stack)
            for ego, controller in zip(egos, controllers, strict=True)
        )
    else:
        waiting = tuple(recorded_ego(ego, driven.tracks[ego.ego_id], time_step) for ego in egos)
    departures = Departures(waiting, sumo, files.config_file, time_step, network)
    if driven is not None and driven.absent:
        departures.forgo(driven.start)
    else:
        departures.run_until_first(goes_on)
    roster = people_at_first(config, departures, way, sumo, files.net_file, network)
    arrivals = people_to_come(config, roster, time_step, sumo, files.net_file, network)
    exchange = None
    if network is not None:
        asked = config.crowd.walls
        walls = walkers and network.has_sidewalks if asked is None else asked
        exchange = Exchange(
            sumo,
            network,
            zone if walkers else Zone("none", 0.0),
            roster,
            walls=walls,
            seed=config.seed,
        )
    model = model_of(config, time_step, roster, threads=config.crowd.threads)
    if network is not None and exchange is not None and exchange.gaps is not None:
        gaps, first, count = exchange.gaps, len(network.signals), len(network.gap_crossings)
        sidewalks = network.sidewalks(gaps.kerbs)
        swept = swept_near(sumo, gaps.ends, sidewalks)
        model = HeldAtKerb(model, first, count, sidewalks, swept, gaps.areas)
        gaps.free = model.free
    yielding = None
    if config.traffic.yielding and (added or walkers or egos):
        yielding = Yielding(sumo.vehicles, sumo.step_length)
    priority = _priority(config, egos, sumo) if added or walkers else None
    return Parts(
        config=config,
        sumo=sumo,
        time_step=time_step,
        substeps=substeps,
        horizon=max((ego.horizon for ego in waiting), default=1)
        if driven is None
        else driven.horizon,
        egos=waiting,
        departures=departures,
        roster=roster,
        arrivals=arrivals,
        crowd_model=model,
        exchange=exchange,
        surroundings=OPEN_GROUND if exchange is None else exchange.surroundings,
        yielding=yielding,
        priority=priority,
        net_file=files.net_file,
        secluded=(
            exchange is None
            and priority is None
            and [path for _, path in files.inputs] == [files.net_file]
            and not config.sumo.options
        ),
        remarks=tuple(remarks),
    )


def _imagined_way(config: RunConfig, sumo: SumoSession) -> EgoPath:
    """The path that an inserted ego would have, in a run without egos."""
    ego = config.ego
    lane_path = sumo.lanes.along(ego.route, ego.lane, start=ego.depart_position)
    return EgoPath.through(lane_path.points)


def _driven_part(way: EgoPath, config: RunConfig) -> Array:
    """The part (k, 2) [m] of a path between departure and goal."""
    ego, line = config.ego, shapely.LineString(way.vertices)
    end = line.length
    if ego.travel_distance is not None:
        end = min(end, ego.depart_position + ego.travel_distance)
    return np.array(substring(line, ego.depart_position, end).coords)


def _priority(
    config: RunConfig, egos: Sequence[EgoRunConfig], sumo: SumoSession
) -> PriorityOnFoot | None:
    """Make the part that tells people of their priority, or None if no ego gives way."""
    if not any(driver.heeds("crossings") for driver in egos or (config,)):
        return None
    priority = PriorityOnFoot(sumo.lanes.crossings, sumo.light_state)
    return priority if len(priority) else None


def start_options(config: RunConfig, moved: bool, outputs: Path | None) -> StartOptions:
    """Return the settings for SUMO.

    Args:
        config: Configuration of the run.
        moved: True if persons or vehicles are to be moved.
        outputs: Folder for SUMO's own outputs, or None to drop them.
    """
    sumo = config.sumo
    seed = config.seed if sumo.seed == "run" else sumo.seed
    return StartOptions(
        seed=None if seed == "scenario" else int(seed),
        fallback_seed=config.seed,
        step_length=sumo.step_length,
        interact=moved,
        outputs=outputs,
        written=sumo.outputs,
        extra=sumo.options,
    )


def types_of(egos: Sequence[EgoRunConfig]) -> str:
    """The vehicle types of all egos to be inserted, and of those to be taken over.

    Args:
        egos: Configurations of the egos.
    """
    bodies = {
        inserted_type(ego.ego.id): VehicleShape(
            ego.vehicle.length or BODY.length, ego.vehicle.width or BODY.width
        )
        for ego in egos
        if not ego.ego.take_over
    }
    return all_types(bodies)


def _remarks_on(network: WalkNetwork, net_file: Path) -> list[str]:
    if network.has_walkingareas or network.has_sidewalks:
        return []
    return [
        f"{net_file.name}: neither sidewalks nor walkingareas; walkers keep to the side of the "
        "roads and go straight over junctions; netconvert's --sidewalks.guess, --walkingareas and "
        "--crossings.guess add them"
    ]
