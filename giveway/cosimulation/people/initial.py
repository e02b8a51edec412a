"""The pedestrians that giveway adds to a run, at its start and later, as persons of SUMO."""

from pathlib import Path

import numpy as np

from giveway.config import RunConfig
from giveway.config.tables.crowd import ENCOUNTERS
from giveway.cosimulation.entry.departures import Departures
from giveway.cosimulation.people.arrivals import Arrivals, require_end
from giveway.cosimulation.people.free_drive import free_drive
from giveway.crowd.generation.encounters import FreeDrive
from giveway.crowd.generation.flows import Flows
from giveway.crowd.generation.scripted import ScriptedPeople
from giveway.crowd.generation.sources import Source, Sources
from giveway.crowd.generation.spawn import PREFIX, Spawned, spawn
from giveway.crowd.roster import Roster
from giveway.crowd.ways import lit_crossings, middle_of
from giveway.errors import ConfigError, CrowdError, ScenarioError
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.scenario_files import free_prefix
from giveway.sumo.session import SumoSession
from giveway.walkways import WalkNetwork
from pedestrian_model import Crowd, PedestrianModelError


def people_at_first(
    config: RunConfig,
    departures: Departures,
    way: EgoPath | None,
    sumo: SumoSession,
    net_file: Path,
    network: WalkNetwork | None,
) -> Roster:
    """The pedestrians that giveway adds at the start.

    Args:
        config: Configuration of the run.
        departures: Departures of its egos.
        way: Path that an ego would have, in a run without egos.
        sumo: The running simulation, to which the people are added.
        net_file: File of the network.
        network: Network in which people can walk, or None if it has not been read yet.

    Raises:
        GivewayError: the people cannot be placed, or have no edge to live on.
    """
    walled = bool(config.crowd.walls)
    if not config.crowd.pedestrians:
        return Roster(walled=walled)
    prefix = free_prefix(PREFIX, (file for file in sumo.start.read if file != net_file))
    way = departures.first_path or way
    drive = free_drive(config, way) if config.crowd.sampler == ENCOUNTERS else None
    spawned = spawn(config.crowd, way, config.seed, prefix, drive)
    for name in departures.names:
        if name in spawned.ids:
            raise ConfigError(f"--ego-id '{name}': a pedestrian has this id; choose another")
    host = config.crowd.host_edge
    if not host:
        host = _host(_middle(config, drive), network or WalkNetwork.read(net_file), net_file)
    sumo.add_persons(spawned.ids, host)
    return Roster(spawned.ids, _crowd(spawned), spawned.traits, walled=walled)


def people_to_come(
    config: RunConfig,
    roster: Roster,
    time_step: float,
    sumo: SumoSession,
    net_file: Path,
    network: WalkNetwork | None,
) -> Arrivals | None:
    """The people who are going to come in, or None if nobody is.

    Args:
        config: Configuration of the run.
        roster: The crowd that they join.
        time_step: Control step of the co-simulation [s].
        sumo: The running simulation, to which they are going to be added.
        net_file: File of the network.
        network: Network in which people can walk, or None if it has not been read yet. Crossings
            with lights need it.

    Raises:
        GivewayError: the run would never end, or the people have no edge to live on.
    """
    crowd = config.crowd
    if not crowd.expects_people:
        return None
    flows = crowd.flow if crowd.flow_scale else ()
    if flows:
        require_end(config, sumo.end)
    files = [file for file in sumo.start.read if file != net_file]
    if crowd.recorded or not crowd.host_edge:
        network = network or WalkNetwork.read(net_file)
    sources: list[Source] = []
    places = [middle_of(flow.start) for flow in flows]
    if flows:
        prefixes = [free_prefix(f"{flow.name}.", files) for flow in flows]
        lit = lit_crossings(sumo.lanes.crossings, () if network is None else network.signals)
        sources.append(Flows(config, roster, prefixes, time_step, lit))
    if crowd.recorded:
        # imported here, since pandas comes with it
        from giveway.cosimulation.people.recorded import recorded_people

        assert network is not None
        recorded = recorded_people(config, roster, time_step, files, network)
        sources += recorded
        places += [source.middle for source in recorded]
    if crowd.scripted:
        scripted = ScriptedPeople(crowd.scripted, roster)
        sources.append(scripted)
        places.append(scripted.middle)
    hosts = [crowd.host_edge] * len(places)
    if not crowd.host_edge:
        assert network is not None
        hosts = [_host((x, y), network, net_file) for x, y in map(Array.tolist, places)]
    return Arrivals(Sources(sources), sumo, hosts)


def _middle(config: RunConfig, drive: FreeDrive | None) -> tuple[float, float]:
    """The point (x, y) [m] in the middle of the added people's area or of the drive."""
    if drive is not None:
        pose = drive.path.pose(drive.departure + drive.distance / 2.0)
        return pose.x, pose.y
    x_min, y_min, x_max, y_max = config.crowd.spawn_area
    return (x_min + x_max) / 2, (y_min + y_max) / 2


def _host(place: tuple[float, float], network: WalkNetwork, net_file: Path) -> str:
    """The edge for pedestrians that is nearest to a place x, y [m]."""
    lane = network.nearest_lane(*place)
    if lane is None:
        raise ScenarioError(
            f"{net_file}: no lane for pedestrians, where SUMO could register the added ones; "
            "build the network with netconvert --sidewalks.guess, or add none (--pedestrians 0)"
        )
    return lane.edge


def _crowd(spawned: Spawned) -> Crowd:
    """The added pedestrians, who walk already: at the desired speed, towards the destination."""
    route = spawned.destination - spawned.position
    direction = route / np.maximum(np.hypot(route[:, 0], route[:, 1]), 1e-9)[:, None]
    try:
        return Crowd.create(
            spawned.position,
            spawned.desired_speed[:, None] * direction,
            spawned.desired_speed,
            [destination[None] for destination in spawned.destination],
        )
    except PedestrianModelError as error:
        raise CrowdError(f"pedestrians cannot be placed: {error}") from error
