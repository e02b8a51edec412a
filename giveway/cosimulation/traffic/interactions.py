"""The interactions of egos and background vehicles: at junctions, at merge points and on the road.

People get the vehicles that approach the crossings where they wait for a gap. Egos get the states
of lights and traffic. Background vehicles let egos with priority go first, keep
behind egos that merge, and brake for pedestrians.
"""

from collections.abc import Sequence

from giveway.cosimulation.traffic.crossing_traffic import CrossingTraffic
from giveway.cosimulation.traffic.junction_approaches import TrafficWatch
from giveway.cosimulation.traffic.merging import Merging
from giveway.cosimulation.traffic.priority import rooms_before
from giveway.cosimulation.traffic.touches import Touches
from giveway.cosimulation.traffic.yielding import Yielding
from giveway.crowd.gap_acceptance import GapAcceptance
from giveway.crowd.roster import Roster
from giveway.ego.ego import Ego
from giveway.ego.rules.junctions import Traffic
from giveway.ego.rules.protocol import Told
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.session import SumoSession


class Meetings:
    """Tells egos and background vehicles about each other, once after each SUMO step.

    Args:
        session: The running simulation.
        yielding: Part that slows background vehicles down, or None if they do not yield.
        gaps: People at crossings where vehicles have priority, or None without such a crossing.

    Attributes:
        pending: True if background vehicles that were slowed down may have to be released.
        touches: Contacts of background vehicles with people.
    """

    pending: bool
    touches: Touches

    def __init__(
        self, session: SumoSession, yielding: Yielding | None, gaps: GapAcceptance | None = None
    ) -> None:
        self._session = session
        self._yielding = yielding
        self._traffic = TrafficWatch(session)
        self._merging = Merging(session.vehicles, session.lanes)
        self._gaps, self._approaches = gaps, CrossingTraffic(session)
        self.pending = False
        self.touches = Touches()

    def let_cross(self, background: BackgroundVehicles, egos: Sequence[Ego]) -> None:
        """Let people at crossings where vehicles have priority decide whether they cross.

        Args:
            background: The background vehicles.
            egos: Egos on the road.
        """
        if self._gaps is not None:
            self._approaches.read(background, egos)
            self._gaps.update(self._approaches.on)

    def update(self, background: BackgroundVehicles, roster: Roster, egos: Sequence[Ego]) -> None:
        """Update the egos' rules and the background vehicles' speed limits.

        Nothing happens if there are no background vehicles, no egos that watch others and nothing
        :attr:`pending`.

        Args:
            background: The background vehicles.
            roster: The pedestrians.
            egos: Egos on the road.
        """
        crowd = roster.crowd
        self.touches.update(self._session.time, background, roster.names, crowd.position)
        rooms = self._look_ahead(background, egos)
        merging = [ego.rules.keeps_behind for ego in egos if ego.rules.situation.merging]
        yielding = self._yielding
        if yielding is not None and (background.ids or yielding.limited):
            waiting = None if self._gaps is None else self._gaps.waiting
            yielding.update(background, crowd, egos, rooms, merging, waiting)
            self.pending = bool(yielding.limited)

    @property
    def report(self) -> dict[str, float]:
        """The numbers of vehicles that yielded, of their time [s], and of people touched if any."""
        report = {} if self._yielding is None else self._yielding.report
        return report | ({"people_touched": len(self.touches)} if len(self.touches) else {})

    def _look_ahead(self, background: BackgroundVehicles, egos: Sequence[Ego]) -> dict[str, float]:
        """Tell egos about lights and traffic; return the room [m] of each vehicle that waits."""
        session, rooms = self._session, dict[str, float]()
        traffic: Traffic = {}
        if any(ego.rules.junctions for ego in egos):
            traffic = self._traffic.of(background, egos)
        for ego in egos:
            if ego.watches:
                states = session.light_states(ego.systems)
                merging = self._merging.of(background, ego, egos)
                ego.update(session.time, Told(states, traffic, merging))
                for name, room in rooms_before(ego, states, traffic).items():
                    rooms[name] = min(room, rooms.get(name, room))
        return rooms
