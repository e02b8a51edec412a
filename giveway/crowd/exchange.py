"""The exchange of the scenario's pedestrians between giveway's crowd and SUMO."""

import math
from collections.abc import Sequence

import numpy as np

from giveway.crowd.gap_acceptance import GapAcceptance
from giveway.crowd.impasses import Impasses
from giveway.crowd.red_walkers import RedWalkers
from giveway.crowd.requests import Requests
from giveway.crowd.roster import Roster
from giveway.crowd.zone import Zone
from giveway.geometry.kernel import Array
from giveway.run_data.footways import Footway, Footways
from giveway.sumo.persons.scenario_persons import Arrival, Person
from giveway.sumo.session import SumoSession
from giveway.walkways import WalkNetwork
from pedestrian_model import Crowd, Surroundings, Walls, targets

_CLOSED = frozenset("rRyYus")  # letters of a crossing's light at which pedestrians wait


class Exchange:
    """Takes the scenario's walkers over in the zone and hands them back outside.

    Args:
        session: Running simulation.
        network: Network of walkways.
        zone: Zone in which giveway moves pedestrians.
        roster: Crowd that walkers join.
        walls: Whether the edges of walkways are walls.
        seed: Seed of the differences between people.

    Attributes:
        gaps: People at crossings where vehicles have priority, or None without such a crossing.
    """

    def __init__(
        self,
        session: SumoSession,
        network: WalkNetwork,
        zone: Zone,
        roster: Roster,
        *,
        walls: bool,
        seed: int = 0,
    ) -> None:
        self._session = session
        self._network = network
        self._zone = zone
        self._roster = roster
        self._walkers = session.persons(roster.added)
        self._states: dict[str, str] = {}
        # For each light, the signals of its crossings and their movements
        self._crossings: dict[str, list[tuple[int, int]]] = {}
        for number, signal in enumerate(network.signals):
            self._crossings.setdefault(signal.tls, []).append((number, signal.link))
        self.unconnected = 0  # number of gaps in routes, between edges that are not connected
        signals = len(network.signals)
        waits = signals + 2 * len(network.gap_crossings)
        with session.hushed:
            red_times = self._walkers.red_times()
        self._red_walkers = RedWalkers(red_times, signals, first=waits)
        self.surroundings = Surroundings(
            walls=Walls.create(network.wall_segments) if walls else None,
            closed=np.zeros(waits + self._red_walkers.size, dtype=np.bool_),
        )
        self._impasses = Impasses(roster, self.surroundings, network.walkable) if walls else None
        self.gaps = self._gaps(seed) if network.gap_crossings else None
        self._requests = Requests(session.light_requests, network.signals)

    def _gaps(self, seed: int) -> GapAcceptance:
        """Return the part that lets people wait at crossings where vehicles have priority."""
        network, closed = self._network, self.surroundings.closed
        known = {place.lane.rpartition("_")[0]: place for place in self._session.lanes.crossings}
        crossings = [known.get(edge) for edge in network.gap_crossings]
        first = len(network.signals)
        closed[first : first + len(crossings)] = [crossing is not None for crossing in crossings]
        return GapAcceptance(self._roster, crossings, first, self._session.step_length, seed)

    @property
    def footways(self) -> Footways:
        """The crossings and edges on which people walk."""
        crossings = [
            Footway(one.lane, one.ends, one.width, bool(one.system))
            for one in self._session.lanes.crossings
        ]
        edges = [Footway(*line, 0.0, False) for line in self._network.centre_lines.items()]
        return Footways(tuple(crossings), tuple(edges))

    def update(self, egos: Array) -> None:
        """Hand people back, take people over and read the lights, once after each SUMO step.

        Args:
            egos: Positions (e, 2) [m] of the egos' front bumpers.
        """
        with self._session.hushed:
            self._hand_back(egos)
            self._take_over(egos)
            if self._walkers.records:
                places = self._roster.crowd.position.tolist()
                names = zip(self._roster.names, places, strict=True)
                self._walkers.records.update((name, x, y) for name, (x, y) in names)
        self._read_lights()  # now, because people who have just joined may wait at a red light
        if self._requests and len(self._roster):
            crowd, time = self._roster.crowd, self._session.time
            self._requests.update(self._states, time, crowd, self.surroundings)
        if self._impasses is not None:
            self._impasses.update(self._session.time)

    def _read_lights(self) -> None:
        """Open or close every crossing by the state of its traffic light."""
        bold = self._red_walkers
        if not len(self._roster) and not bold:
            return
        closed = self.surroundings.closed
        for system, crossings in self._crossings.items():
            state = self._session.light_state(system)
            before = self._states.get(system, "")
            if state != before:
                self._states[system] = state
                for number, link in crossings:
                    closed[number] = state[link] in _CLOSED
                    if bold and state[link] != before[link : link + 1]:
                        bold.note(number, state[link], self._session.time)
        if bold:
            bold.close(closed, self._session.time)

    def _take_over(self, egos: Array) -> None:
        if self._zone.nowhere:
            return
        ids, places = self._walkers.positions()
        inside = self._zone.enters(places, egos)
        if not inside.any():
            return
        walkers = self._walkers.take([ids[i] for i in np.flatnonzero(inside)])
        if walkers:
            self._roster.take_in([walker.id for walker in walkers], self._crowd(walkers))
        if self.gaps is not None:
            for walker in walkers:
                self.gaps.meet(walker.id, self._walkers.gap_habit(walker))

    def _crowd(self, walkers: Sequence[Person]) -> Crowd:
        routes = [
            self._network.route(
                walker.edges,
                position=(walker.x, walker.y),
                lane=walker.lane,
                arrival_position=walker.arrival_position,
            )
            for walker in walkers
        ]
        self.unconnected += sum(route.gaps for route in routes)
        velocity = [(w.speed * math.cos(w.heading), w.speed * math.sin(w.heading)) for w in walkers]
        return Crowd.create(
            [(w.x, w.y) for w in walkers],
            velocity,
            [w.desired_speed for w in walkers],
            [route.waypoints for route in routes],
            passages=[route.passages for route in routes],
            signals=[
                self._red_walkers.signals_for(walker.type, route.signals)
                for walker, route in zip(walkers, routes, strict=True)
            ],
        )

    def _hand_back(self, egos: Array) -> None:
        """Hand back people outside of the zone who are near a lane. The others walk on."""
        roster = self._roster
        if self._zone.everywhere or not self._walkers.held:
            return
        outside = ~self._zone.keeps(roster.crowd.position, egos)
        if not outside.any():
            return
        gone = np.zeros(len(roster), dtype=np.bool_)
        rows = np.flatnonzero(outside)
        ways = targets(roster.crowd, rows) - roster.crowd.position[rows]
        for i, way in zip(rows, ways.tolist(), strict=True):
            name = roster.ids[roster.person_ids[i]]
            if name not in self._walkers.held:
                continue  # giveway added this person
            x, y = roster.crowd.position[i].tolist()
            lane = self._network.nearest_lane(x, y)
            if lane is not None:
                gone[i] = self._walkers.hand_back(name, x, y, lane.edge, tuple(way))
        if gone.any():
            roster.count("handed_back", len(roster.release(gone)))

    def arrive(self, names: Sequence[str]) -> list[str]:
        """End walks in SUMO's next step, and return the ``names`` that are not SUMO's persons."""
        others = []
        for name in names:
            if name not in self._walkers.held:
                others.append(name)
                continue
            arrival = self._walkers.arrive(name)
            self._roster.count("arrived" if arrival is Arrival.ARRIVED else "continued")
        return others
