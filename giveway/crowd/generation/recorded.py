"""Lets recorded people in: where, when and as fast as they were recorded."""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np

from giveway.crowd.motion.as_recorded import WrittenWalk
from giveway.crowd.roster import Roster, Trait
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

# Distance [m] that a person goes at least; one who does not stands, and leaves when recorded to
_NOWHERE = 1.0
_SAME = 1e-6  # Difference [s] up to which two instants are one


class RecordedPerson(NamedTuple):
    """A recorded person, in the network and on the run's clock.

    Attributes:
        name: Id of the person in the run.
        time: Times (R,) [s] after the run's start.
        position: Positions (R, 2) [m].
        velocity: Velocities (R, 2) [m/s].
        desired_speed: Desired speed [m/s].
        destination: Destination (2,) [m] of the person in a simulated walk.
    """

    name: str
    time: Array
    position: Array
    velocity: Array
    desired_speed: float
    destination: Array

    def walk(self, begin: float, time_step: float) -> WrittenWalk:
        """Return the walk at the control instants from the time ``begin`` [s] on."""
        count = int((self.time[-1] - begin) / time_step + _SAME) + 1
        at = begin + time_step * np.arange(count)
        return WrittenWalk(
            np.column_stack([np.interp(at, self.time, self.position[:, axis]) for axis in (0, 1)]),
            np.column_stack([np.interp(at, self.time, self.velocity[:, axis]) for axis in (0, 1)]),
        )


class RecordedPeople:
    """The people of one recording who come into a crowd.

    Args:
        people: Recorded people.
        roster: Crowd that they join.
        time_step: Time step of the co-simulation [s].
        follow: True if they walk as recorded, False if a model moves them at once.
        kind: Kind of these people; empty for adults.
        judged: True to judge their contacts as those of people who react.
    """

    def __init__(
        self,
        people: Sequence[RecordedPerson],
        roster: Roster,
        time_step: float,
        *,
        follow: bool,
        kind: str = "",
        judged: bool = False,
    ) -> None:
        self._people = tuple(people)
        self._roster = roster
        self._time_step = time_step
        self._follow, self._kind, self._judged = follow, kind, judged
        self._coming = sorted(self._people, key=lambda person: (float(person.time[0]), person.name))
        self._step = -1
        self._entered: list[str] = []  # ids of people who react from the next call on

    @property
    def middle(self) -> Array:
        """The mean (2,) [m] of the places at which people are seen first."""
        return np.asarray(np.mean([person.position[0] for person in self._people], axis=0))

    def afresh(self, roster: Roster) -> Self:
        """Return the same people from their beginning, for another crowd."""
        return type(self)(
            self._people,
            roster,
            self._time_step,
            follow=self._follow,
            kind=self._kind,
            judged=self._judged,
        )

    def enter(self, step: int) -> list[list[str]]:
        """Let those in who are due at the control step ``step``; return their ids, as one list.

        A person who has left the recording by then stays away. A second call for the same step lets
        nobody in.
        """
        if step <= self._step:
            return [[]]
        self._step = step
        for name in self._entered:
            self._roster.written.note(name, reacts=True)
        self._entered = []
        time = step * self._time_step + _SAME
        due = [person for person in self._coming if person.time[0] <= time]
        self._coming = self._coming[len(due) :]
        there = [person for person in due if person.time[-1] >= time + self._time_step]
        self._join(there, step)
        return [[person.name for person in there]]

    def _join(self, people: Sequence[RecordedPerson], step: int) -> None:
        if not people:
            return
        roster = self._roster
        walks = [person.walk(step * self._time_step, self._time_step) for person in people]
        roster.add(
            [person.name for person in people],
            Crowd.create(
                [walk.position[0] for walk in walks],
                [walk.velocity[0] for walk in walks],
                [person.desired_speed for person in people],
                [person.destination[None] for person in people],
            ),
            {person.name: Trait(self._kind) for person in people} if self._kind else {},
        )
        for person, walk in zip(people, walks, strict=True):
            if self._follow:
                roster.written.add(person.name, walk)
            elif not self._judged:  # nobody can react to a vehicle in whose place they are put
                self._entered.append(person.name)
            if not self._judged:
                roster.written.note(person.name, reacts=False)
            if np.hypot(*(walk.position[-1] - walk.position[0])) < _NOWHERE:
                roster.stay(person.name, step + len(walk.position) - 1)

    @property
    def identity(self) -> bytes:
        """The bytes of all tracks, since the file of a recording may change."""
        arrays = [array for one in self._people for array in (one.time, one.position, one.velocity)]
        return b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)

    @property
    def keeps_coming(self) -> bool:
        """Return whether somebody is still to come in."""
        return bool(self._coming)

    @property
    def remarks(self) -> list[str]:
        """The remarks on people who waited; nobody does."""
        return []
