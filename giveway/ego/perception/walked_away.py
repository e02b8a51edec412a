"""People who have walked away behind something: they count as people who are not seen."""

from math import cos, sin

import numpy as np

from giveway.ego.perception.hidden_people import TellsUnseen
from giveway.ego.perception.protocol import Ids, OwnState, Percept

_ROUNDING = 1e-9  # s


class WalkedAway:
    """Leaves out remembered people who have walked away behind something ahead, until seen again.

    The longer nobody sees them, the less is known of their velocities: an ego would brake as hard
    as it can for those who could have turned round. Hiding places allow for their coming out.

    Args:
        sensor: Sensor that tells where people would not be in sight.
    """

    def __init__(self, sensor: TellsUnseen) -> None:
        self._sensor = sensor
        self._gone: Ids = np.empty(0, dtype=np.int64)

    def left_out(self, percept: Percept, ego: OwnState) -> Percept:
        """Return the percept without them.

        Args:
            percept: Percept of the sensor.
            ego: State of the ego.
        """
        if percept.age is None or not (lost := percept.age > self._sensor.delay + _ROUNDING).any():
            return percept
        (x, y, heading), people, ids = ego.pose, percept.people, percept.person_ids
        ahead, aside = np.array([[cos(heading), sin(heading)], [-sin(heading), cos(heading)]])
        off = people.position - (x, y)
        away = lost & (off @ ahead > 0.0) & ((off @ aside) * (people.velocity @ aside) > 0.0)
        away[away] = self._sensor.unseen(people.position[away])
        away |= lost & np.isin(ids, self._gone)
        self._gone = ids[away]
        if not away.any():
            return percept
        known = (None if told is None else told[~away] for told in percept[2:])
        return Percept(people.select(~away), ids[~away], *known)
