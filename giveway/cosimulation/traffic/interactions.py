"""The places where egos and other vehicles meet: junctions, merge points and the road.

Egos take note of lights and traffic; background vehicles let those egos go first that may, keep
behind those that merge, and brake for pedestrians.
"""

from collections.abc import Sequence

from giveway.cosimulation.traffic.junction_approaches import TrafficWatch
from giveway.cosimulation.traffic.merging import Merging
from giveway.cosimulation.traffic.priority import rooms_before
from giveway.cosimulation.traffic.yielding import Yielding
from giveway.ego.ego import Ego
from giveway.ego.rules.junctions import Traffic
from giveway.ego.rules.protocol import Told
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.session import SumoSession
from pedestrian_model import Crowd


class Meetings:
    """Lets egos and background vehicles know of each other, once after each of SUMO's steps.

    Args:
        session: The running simulation.
        yielding: slows background vehicles down; None: they do not heed what giveway moves.

    Attributes:
        pending: Background vehicles that were slowed down may have to be released.
    """

    pending: bool

    def __init__(self, session: SumoSession, yielding: Yielding | None) -> None:
        self._session = session
        self._yielding = yielding
        self._traffic = TrafficWatch(session)
        self._merging = Merging(session.vehicles, session.lanes)
        self.pending = False

    def update(self, background: BackgroundVehicles, crowd: Crowd, egos: Sequence[Ego]) -> None:
        """Look at everybody who is on the road now.

        Without background vehicles, egos that watch and :attr:`pending` it does nothing.

        Args:
            background: The background vehicles.
            crowd: The pedestrians.
            egos: Egos on the road.
        """
        rooms = self._look_ahead(background, egos)
        merging = [ego.rules.keeps_behind for ego in egos if ego.rules.situation.merging]
        yielding = self._yielding
        if yielding is not None and (background.ids or yielding.limited):
            yielding.update(background, crowd, egos, rooms, merging)
            self.pending = bool(yielding.limited)

    def _look_ahead(self, background: BackgroundVehicles, egos: Sequence[Ego]) -> dict[str, float]:
        """Let egos take note of lights and traffic; who has to wait for one, and the room [m]."""
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
