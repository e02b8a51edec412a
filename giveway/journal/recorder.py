"""The recorder of a run's rows, from giveway's own state and not from SUMO's."""

import json
from collections.abc import Mapping, Sequence
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array, kernel
from giveway.journal.journal import Journal
from giveway.journal.layout import EGO_NUMBERS, EGO_TEXTS, NAMES, ROWS, STORED
from giveway.journal.recorded import RecordedRows
from giveway.run_data.rows import LEDGER
from giveway.run_data.tracks import EgoRow
from giveway.run_data.way import EgoWay
from giveway.sumo.background import BackgroundVehicles

Indices = NDArray[np.int64]
# Functions that return the numbers and texts of a row
_numbers, _texts = attrgetter(*EGO_NUMBERS), attrgetter(*EGO_TEXTS)


class Recorder:
    """Records the state of the run at each control instant.

    Args:
        journal: Journal that keeps the rows if this process dies.
    """

    def __init__(self, journal: Journal | None = None) -> None:
        self.journal = journal or Journal(None)
        self._rows = {
            name: self.journal.rows(name, columns, stored=name == STORED)
            for name, columns in ROWS.items()
        }
        self._names = {name: self.journal.names(name) for name in NAMES}
        self._word = self._names["words"].index
        self._ego, self._crowd = self._rows["ego"], self._rows["crowd"]
        self._keys: dict[tuple[str, str], int] = {}
        self._counts: Mapping[str, int] = {}
        self._steps = 0

    def instant(self, time: float) -> None:
        """Begin the next control instant, at ``time`` [s]."""
        self._rows["clock"].add(time)
        self._steps += 1

    def name_pedestrians(
        self, ids: Sequence[str], traits: Mapping[str, tuple[str, str]] | None = None
    ) -> None:
        """Note the names of pedestrians, in the order of their indices.

        Args:
            ids: Ids of the pedestrians.
            traits: Kind and group of the people who have any.
        """
        for name in ids:
            self._names["pedestrians"].index(name)
            if traits and name in traits:
                self._names["traits"].index(json.dumps([name, *traits[name]]))

    def drive(self, ego_id: str, shape: VehicleShape, goal: float) -> None:
        """Note an ego that departs: its body and the distance [m] that it is to drive."""
        self._rows["drives"].add(self._names["egos"].index(ego_id), shape.length, shape.width, goal)

    def outputs(
        self, ego_id: str, record: Sequence[tuple[str, str, str]], values: Sequence[float]
    ) -> None:
        """Record the variables that an FMU's profile lists, at the present control instant.

        Args:
            ego_id: Id of the ego that the FMU drives.
            record: Name, unit and description of each variable.
            values: Values of the variables.
        """
        block = self._rows["outputs"].block(len(record))
        for row, (about, value) in enumerate(zip(record, values, strict=True)):
            key = self._keys.get((ego_id, about[0]))
            if key is None:
                key = self._names["outputs"].index(json.dumps([ego_id, *about]))
                self._keys[ego_id, about[0]] = key
            block[row] = self._steps - 1, key, value

    def way(self, way: EgoWay) -> None:
        """Record the path of a departing ego, with its crossings, lights, junctions and stops."""
        self._names["ways"].index(way.to_json())

    def signal(self, time: float, system: str, state: str) -> None:
        """Record the state that a traffic light has from ``time`` [s] on."""
        self._rows["signals"].add(time, self._word(system), self._word(state))

    def walk(self, pedestrian: int, desired_speed: float, places: Array) -> None:
        """Record the route on which a pedestrian plans to walk from the present instant on.

        Args:
            pedestrian: Index of the pedestrian.
            desired_speed: Desired speed [m/s].
            places: Position of the pedestrian and its way-points (k, 2) [m].
        """
        block = self._rows["people"].block(len(places))
        block[:, 0] = self._steps - 1
        block[:, 1] = pedestrian
        block[:, 2] = desired_speed
        block[:, 3:] = places

    def ledger(self, counts: Mapping[str, int]) -> None:
        """Note the counts of pedestrians, if they have changed; the latest row counts."""
        if counts != self._counts:
            self._counts = counts
            self._rows["ledger"].add(*(counts[name] for name in LEDGER))

    def ego(self, ego_id: str, row: EgoRow) -> None:
        """Record an ego at the present control instant."""
        self._ego.add(
            self._steps - 1,
            self._names["egos"].index(ego_id),
            *_numbers(row),
            *map(self._word, _texts(row)),
        )

    def hasty(self, ego_id: str, pedestrians: Indices) -> None:
        """Note the people who started more suddenly than the safety layer assumes."""
        block = self._rows["hasty"].block(len(pedestrians))
        block[:, 0], block[:, 1] = self._names["egos"].index(ego_id), pedestrians

    def sights(self, time: float, ego_id: str, changes: Array) -> None:
        """Record who comes in sight of an ego, or is lost from sight, at ``time`` [s].

        Args:
            time: Time [s].
            ego_id: Id of the ego.
            changes: Rows (k, 3): index of the pedestrian, 1 or 0, distance [m].
        """
        block = self._rows["sights"].block(len(changes))
        block[:, 0], block[:, 1] = time, self._names["egos"].index(ego_id)
        block[:, 2:] = changes

    def reacting(self, pedestrian: int, reacts: bool) -> None:
        """Note that a pedestrian begins to react to vehicles, or walks in without doing so."""
        self._rows["reacting"].add(self._steps - 1, pedestrian, reacts)

    def crowd(
        self, person_ids: Indices, position: Array, velocity: Array, egos: Array, within: float
    ) -> None:
        """Record the crowd at the present control instant.

        Args:
            person_ids: Index (n,) of each pedestrian.
            position: Positions (n, 2) [m].
            velocity: Velocities (n, 2) [m/s].
            egos: Positions (e, 2) [m] of the egos.
            within: Distance [m] from an ego; pedestrians farther from every ego are left out.
        """
        block = self._crowd.block(len(person_ids))
        filled = fill_near(self._steps - 1, person_ids, position, velocity, egos, within, block)
        self._crowd.give_back(len(person_ids) - filled)

    def predictions(
        self, ego_id: str, pedestrians: Indices, look_ahead: Array, positions: Array
    ) -> None:
        """Record the positions of people that an ego's controller expects from now on.

        Args:
            ego_id: Id of the ego.
            pedestrians: Indices (n,) of the predicted pedestrians.
            look_ahead: Prediction times ahead (m,) [s].
            positions: Predicted positions (m, n, 2) [m].
        """
        block = self._rows["predictions"].block(look_ahead.size * pedestrians.size)
        block[:, 0] = self._steps - 1
        block[:, 1] = self._names["egos"].index(ego_id)
        block[:, 2] = np.tile(pedestrians, look_ahead.size)
        block[:, 3] = np.repeat(look_ahead, pedestrians.size)
        block[:, 4:] = positions.reshape(-1, 2)

    def background(
        self, time: float, vehicles: BackgroundVehicles, egos: Array, within: float
    ) -> None:
        """Record SUMO's vehicles at ``time`` [s]; for ``egos``, ``within`` see :meth:`crowd`."""
        near = np.full(len(vehicles.ids), np.isinf(within))
        for x, y in egos:
            near |= np.hypot(vehicles.x - x, vehicles.y - y) <= within
        wanted = np.flatnonzero(near)
        if not len(wanted):
            return
        index = self._names["vehicles"].index
        block = self._rows["background"].block(len(wanted))
        block[:, 0] = time
        block[:, 1] = [index(vehicles.ids[i]) for i in wanted]
        block[:, 2] = [index(vehicles.types[i]) for i in wanted]
        for column, values in enumerate(vehicles.numbers, start=3):
            block[:, column] = values[wanted]

    def timing(self, *seconds: float) -> None:
        """Record the computing times of one control step, in the order of ``Timings.NAMES``."""
        self._rows["timing"].add(*seconds)

    def rows(self) -> RecordedRows:
        """Return all rows recorded so far."""
        return RecordedRows(
            {name: rows.whole for name, rows in self._rows.items()},
            {name: names.names for name, names in self._names.items()},
        )


@kernel
def fill_near(
    step: int,
    person_ids: Indices,
    position: Array,
    velocity: Array,
    egos: Array,
    within: float,
    block: Array,
) -> int:
    """Fill the crowd's rows of one step with the pedestrians near an ego; return their number."""
    count = 0
    for i in range(len(person_ids)):
        near = np.isinf(within)
        for j in range(len(egos)):
            d_x, d_y = position[i, 0] - egos[j, 0], position[i, 1] - egos[j, 1]
            near |= d_x * d_x + d_y * d_y <= within * within
        if near:
            block[count, 0] = step
            block[count, 1] = person_ids[i]
            block[count, 2] = position[i, 0]
            block[count, 3] = position[i, 1]
            block[count, 4] = velocity[i, 0]
            block[count, 5] = velocity[i, 1]
            count += 1
    return count
