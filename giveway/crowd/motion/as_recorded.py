"""The model ``recorded``: people walk as they were recorded until a vehicle comes near.

People who walk by a script do so whatever comes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from giveway.crowd.motion.attention import distances
from giveway.crowd.motion.neighbours import AroundModel
from giveway.crowd.motion.scripted import ScriptedWalk
from giveway.geometry.kernel import Array
from pedestrian_model import OPEN_GROUND, Crowd, PedestrianModel, Surroundings, Vehicles

_SPEED = 3  # column of the speed among the numbers of a vehicle


@dataclass(frozen=True, eq=False)
class WrittenWalk:
    """The walk of a recorded person, at each control instant from the first one on.

    Attributes:
        position: Positions (K, 2) [m].
        velocity: Velocities (K, 2) [m/s].
    """

    position: Array
    velocity: Array


class WrittenWalks:
    """The written walks of the people who do not react to vehicles yet.

    Attributes:
        changes: Ids of people, each with True from when they react and False before, in the order
            in which it became known.
        scripts: Walks of the people who never react, by their ids.
    """

    def __init__(self) -> None:
        self.changes: list[tuple[str, bool]] = []
        self.scripts: dict[str, ScriptedWalk] = {}
        self._walks: dict[str, WrittenWalk] = {}
        self._reached: dict[str, int] = {}

    def __contains__(self, name: object) -> bool:
        return name in self._walks

    def __len__(self) -> int:
        return len(self._walks)

    def add(self, name: str, walk: WrittenWalk) -> None:
        """Let a person who joins the crowd at the first instant of ``walk`` follow it."""
        self._walks[name] = walk
        self._reached[name] = 0

    def note(self, name: str, *, reacts: bool) -> None:
        """Note that a person reacts to vehicles from now on, or does not yet."""
        self.changes.append((name, reacts))

    def release(self, name: str) -> None:
        """Let a person react from now on."""
        del self._walks[name]
        self.note(name, reacts=True)

    def has_ended(self, name: str) -> bool:
        """Return whether a person has followed the written walk to its end."""
        return self._reached[name] >= len(self._walks[name].position) - 1

    def forget(self, name: str) -> None:
        """Drop the walk of a person who has left the crowd."""
        self._walks.pop(name, None)

    def go_on(self, name: str) -> tuple[Array, Array]:
        """Return the position (2,) [m] and velocity (2,) [m/s] of a person one instant later."""
        walk = self._walks[name]
        at = self._reached[name] = min(self._reached[name] + 1, len(walk.position) - 1)
        return walk.position[at], walk.velocity[at]


class AsRecorded(AroundModel):
    """A model whose people follow their written walks until a vehicle comes near.

    The wrapped model then moves them, and all people without a written walk. It steps the whole
    crowd, so that those who react also avoid those who do not.

    Args:
        model: Model that moves people after the hand-over; one without a memory.
        walks: Written walks.
        names: Function that returns the ids (n,) of the people in the crowd.
        time: Time [s]: a person reacts if a vehicle at its speed could be there so soon.
        distance: Distance [m] to a vehicle's outline from which on a person reacts.
    """

    def __init__(
        self,
        model: PedestrianModel,
        walks: WrittenWalks,
        names: Callable[[], Sequence[str]],
        *,
        time: float,
        distance: float,
    ) -> None:
        super().__init__(model)
        self._walks, self._names = walks, names
        self._time, self._distance = time, distance

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Step the crowd in place."""
        written = [(row, name) for row, name in enumerate(self._names()) if name in self._walks]
        if written and len(vehicles):
            rows = [row for row, _ in written]
            reach = np.maximum(self._distance, self._time * np.abs(vehicles.array[:, _SPEED]))
            near = np.any(distances(crowd.position[rows], vehicles) < reach, axis=1)
            for (_, name), reacts in zip(written, near.tolist(), strict=True):
                if reacts:
                    self._walks.release(name)
        self._model.advance(crowd, vehicles, surroundings)
        for row, name in written:
            if name in self._walks:
                crowd.position[row], crowd.velocity[row] = self._walks.go_on(name)
        scripts = self._walks.scripts
        for row, name in enumerate(self._names() if scripts else ()):
            if name in scripts:
                walk = scripts[name].go_on(vehicles, self.time_step)
                crowd.position[row], crowd.velocity[row] = walk
