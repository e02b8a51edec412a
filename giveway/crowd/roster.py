"""The pedestrians that giveway moves: their ids and traits, and how they join and leave."""

import hashlib
import itertools
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.config.tables.people import DISTRACTED
from giveway.crowd.motion.as_recorded import WrittenWalks
from giveway.crowd.motion.sway import sway_of
from pedestrian_model import (
    OFF_WALKWAYS,
    Crowd,
    PedestrianModel,
    Surroundings,
    Vehicles,
    any_arrived,
    arrived,
)

ARRIVAL_RADIUS = 0.5  # distance [m] to the destination, within which a pedestrian has arrived


class Trait(NamedTuple):
    """The kind and the group of a pedestrian that giveway adds."""

    kind: str = ""  # kind, as in kinds.py; empty without a kind
    group: str = ""  # id of the group's first member; empty for single people


_NOTHING = Trait()


class Roster:
    """The crowd, and the ids of its people.

    Args:
        ids: Ids of the people at first, whom giveway adds.
        crowd: State of these people.
        traits: Traits of those who have any, by their ids.
        walled: Whether walls hold the people that giveway adds.

    Attributes:
        ids: Ids of all people who ever were in the crowd; the tables refer to them by index.
        crowd: State of the people who are in the crowd now.
        person_ids: Index (n,) into ``ids`` of each pedestrian in the crowd.
        names: Ids of the pedestrians in the crowd.
        newcomers: Indices of the people who joined since the list was last emptied.
        added: Ids of the people that giveway added; the others are the scenario's own.
        traits: Traits of the people who have any, by their ids.
        written: Walks of the people who move as they were recorded.
    """

    def __init__(
        self,
        ids: Sequence[str] = (),
        crowd: Crowd | None = None,
        traits: Mapping[str, Trait] | None = None,
        *,
        walled: bool = True,
    ) -> None:
        self._walled = walled
        self.ids: list[str] = list(ids)
        self.crowd = Crowd.empty() if crowd is None else self._let_walk(crowd)
        self.person_ids = np.arange(len(self.ids))
        self.names = list(ids)
        self.added = set(ids)
        self.traits = dict(traits or {})
        self.written = WrittenWalks()
        self._stays: dict[str, int] = {}
        self.newcomers = list(range(len(self.ids)))
        self._index = {name: i for i, name in enumerate(self.ids)}
        self._keys: list[int] = []
        self._distracted: list[bool] = []
        self._groups: list[int] = []
        self._counts = {"taken_over": 0, "handed_back": 0, "arrived": 0, "continued": 0}

    def __len__(self) -> int:
        return len(self.person_ids)

    def index(self, name: str) -> int:
        """Return the index into ``ids`` of a person."""
        return self._index[name]

    @property
    def ledger(self) -> dict[str, int]:
        """The counts: added + taken_over = handed_back + arrived + continued + walking."""
        added, walking = len(self.added), len(self.person_ids)
        return {"added": added, **self._counts, "walking": walking}

    @property
    def keys(self) -> NDArray[np.int64]:
        """A number (n,) for each pedestrian that depends on the id alone."""
        for name in itertools.islice(self.ids, len(self._keys), None):
            digest = hashlib.blake2b(name.encode(), digest_size=8).digest()
            self._keys.append(int.from_bytes(digest, "big") >> 1)
        return np.array(self._keys, dtype=np.int64)[self.person_ids]

    @property
    def distracted(self) -> NDArray[np.bool_]:
        """The marks (n,) of distracted pedestrians."""
        self._learn()
        return np.array(self._distracted, dtype=np.bool_)[self.person_ids]

    @property
    def groups(self) -> NDArray[np.int64]:
        """The index (n,) of each pedestrian's group; -1 for single people."""
        self._learn()
        return np.array(self._groups, dtype=np.int64)[self.person_ids]

    def _learn(self) -> None:
        """Store the traits of new people."""
        for name in itertools.islice(self.ids, len(self._groups), None):
            trait = self.traits.get(name, _NOTHING)
            self._distracted.append(trait.kind == DISTRACTED)
            self._groups.append(self._index[trait.group] if trait.group else -1)

    def add(self, names: Sequence[str], crowd: Crowd, traits: Mapping[str, Trait]) -> None:
        """Add people of giveway's own during the run."""
        self.added.update(names)
        self.traits |= traits
        self._join(names, self._let_walk(crowd))

    def _let_walk(self, crowd: Crowd) -> Crowd:
        """Let added people walk off the walkways, unless walls hold them, too."""
        if not self._walled:
            crowd.waypoint_signal[crowd.waypoint_signal < 0] = OFF_WALKWAYS
        return crowd

    def take_in(self, names: Iterable[str], crowd: Crowd) -> None:
        """Add people of the scenario. A person who comes back keeps the index."""
        names = list(names)
        self._join(names, crowd)
        self._counts["taken_over"] += len(names)

    def _join(self, names: Sequence[str], crowd: Crowd) -> None:
        indices = []
        for name in names:
            if name not in self._index:
                self._index[name] = len(self.ids)
                self.ids.append(name)
            indices.append(self._index[name])
        self.person_ids = np.concatenate([self.person_ids, np.array(indices, dtype=np.int64)])
        self.newcomers += indices
        self.names += names
        self.crowd = self.crowd.concatenate(crowd) if len(self.crowd) else crowd

    def release(self, gone: NDArray[np.bool_]) -> list[str]:
        """Remove the people marked in ``gone`` (n,) from the crowd, and return their ids."""
        names = [self.names[i] for i in np.flatnonzero(gone)]
        self.names = list(itertools.compress(self.names, (~gone).tolist()))
        self.crowd = self.crowd.select(~gone)
        self.person_ids = self.person_ids[~gone]
        return names

    def stay(self, name: str, until: int) -> None:
        """Keep a person, though at the destination, until the control step ``until``."""
        self._stays[name] = until

    @property
    def holds(self) -> bool:
        """True if somebody leaves for another reason than to be at the destination."""
        return bool(self._stays or len(self.written))

    def leaving(self, there: NDArray[np.bool_], step: int) -> NDArray[np.bool_]:
        """Return marks (n,) of the people who leave the crowd at a control step.

        Args:
            there: Marks (n,) of the people at their destination.
            step: Index of the control step.
        """
        leaving = there.copy()
        for row, name in enumerate(self.names):
            if name in self.written:
                leaving[row] &= self.written.has_ended(name)
                if self.written.has_ended(name) and not there[row]:
                    self.written.release(name)  # the destination is beyond the written walk
            elif name in self._stays:
                leaving[row] &= step >= self._stays[name]
        for row in np.flatnonzero(leaving).tolist():
            self.written.forget(self.names[row])
        return leaving

    def count(self, event: str, number: int = 1) -> None:
        """Count an event of pedestrians who left the crowd."""
        self._counts[event] += number


class Log(Protocol):
    """A log of people's positions and arrivals."""

    def note(
        self, step: int, ids: Sequence[str], person_ids: NDArray[np.int64], crowd: Crowd
    ) -> None:
        """Note the positions of ``person_ids`` at a control instant."""

    def arrive(self, step: int, pedestrians: NDArray[np.int64]) -> None:
        """Note the pedestrians who reached their last way-point at a control instant."""


class Walking:
    """Steps a crowd.

    Args:
        config: Configuration of the run.
        model: Model of the crowd.
        roster: Crowd that is stepped, and its ids.
        log: Log of positions and arrivals, or None if it is not needed.
    """

    def __init__(
        self, config: RunConfig, model: PedestrianModel, roster: Roster, log: Log | None = None
    ) -> None:
        self._model = model
        self._roster = roster
        self._log = log
        self._sway = sway_of(config, model, config.seed)

    def note(self, step: int) -> None:
        """Note the positions of all people at the control instant ``step``."""
        if self._log is not None:
            roster = self._roster
            self._log.note(step, roster.ids, roster.person_ids, roster.crowd)

    def advance(self, step: int, vehicles: Vehicles, surroundings: Surroundings) -> list[str]:
        """Step the crowd from the control instant ``step``, and return the ids of arrivals.

        Args:
            step: Index of the control instant.
            vehicles: Vehicles that people react to.
            surroundings: Walls and lights that people heed.
        """
        roster = self._roster
        if not len(roster.person_ids):
            return []
        crowd = roster.crowd
        if self._sway is None:
            self._model.advance(crowd, vehicles, surroundings)
        else:
            self._sway.advance(crowd, vehicles, surroundings, roster.person_ids, len(roster.ids))
        if not (roster.holds or any_arrived(roster.crowd, ARRIVAL_RADIUS)):
            return []
        there = arrived(roster.crowd, ARRIVAL_RADIUS)
        if roster.holds:
            there = roster.leaving(there, step + 1)
            if not there.any():
                return []
        if self._log is not None:
            self._log.arrive(step + 1, roster.person_ids[there])
        return roster.release(there)
