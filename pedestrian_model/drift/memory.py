"""The memory of what people did in the last seconds, by person id."""

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import kernel
from pedestrian_model.crowd import Crowd
from pedestrian_model.drift.features import FEATURES, fill_features, steps_back

Array = NDArray[np.float64]
Ids = NDArray[np.int64]


class Memory:
    """The states of people at the latest instants, in a ring.

    Args:
        time_step: Time [s] between two instants.
    """

    def __init__(self, time_step: float) -> None:
        self._time_step = time_step
        self._back = steps_back(time_step)
        self._tracks = np.empty((int(self._back.max()) + 1, 0, 4))
        self._newest, self._look = 0, 0
        self._known, self._seen = np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        self._everybody = np.zeros(0, dtype=np.int64)

    def remember(self, people: Crowd, person_ids: Ids) -> None:
        """Add the states of all people who are seen at an instant.

        Args:
            people: People (n,).
            person_ids: Id (n,) of each.
        """
        self._reserve(int(person_ids.max(initial=-1)) + 1)
        self._newest = (self._newest - 1) % len(self._tracks)
        self._look += 1
        _keep(
            (self._tracks, self._newest),
            (self._known, self._seen, self._look),
            (person_ids, people.position, people.velocity),
        )
        self._everybody = person_ids

    def numbers(self, person_ids: Ids) -> tuple[Array, Array]:
        """Return the headings (n, 2) and numbers (n, FEATURES) of people who are seen now."""
        heading, numbers = np.empty((len(person_ids), 2)), np.empty((len(person_ids), FEATURES))
        fill_features(
            self._tracks,
            self._newest,
            self._everybody,
            self._known,
            self._back,
            self._time_step,
            (person_ids, heading, numbers),
        )
        return heading, numbers

    def _reserve(self, people: int) -> None:
        """Provide room for ids below ``people``."""
        room = self._tracks.shape[1]
        if people <= room:
            return
        more = 2 * people - room
        self._tracks = np.concatenate(
            [self._tracks, np.zeros((len(self._tracks), more, 4))], axis=1
        )
        self._known = np.concatenate([self._known, np.zeros(more, dtype=np.int64)])
        self._seen = np.concatenate([self._seen, np.full(more, -1)])


@kernel
def _keep(
    ring: tuple[Array, int], counts: tuple[Ids, Ids, int], now: tuple[Ids, Array, Array]
) -> None:
    """Keep the states of an instant.

    Args:
        ring: Positions and velocities (K, m, 4) of the latest instants; row of this instant.
        counts: Number (m,) of earlier states in a row that are known of each person; number (m,)
            of the instant at which each was seen last; number of this instant.
        now: Id (n,), position (n, 2) [m] and velocity (n, 2) [m/s] of each person.
    """
    (tracks, newest), (known, seen, look), (person_ids, position, velocity) = ring, counts, now
    for i in range(person_ids.shape[0]):
        person = person_ids[i]
        again = seen[person] == look - 1
        known[person] = min(known[person] + 1, tracks.shape[0] - 1) if again else 0
        seen[person] = look
        for axis in range(2):
            tracks[newest, person, axis] = position[i, axis]
            tracks[newest, person, 2 + axis] = velocity[i, axis]
