"""The rows of a run, as a recorder or a journal hands them over, and as tracks."""

import json
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.journal.journal import Array
from giveway.run_data.outputs import Output
from giveway.run_data.rows import LEDGER
from giveway.run_data.tracks import (
    BackgroundTrack,
    CrowdTrack,
    EgoTrack,
    PeopleTrack,
    PredictionTrack,
    SignalTrack,
    Timings,
)
from giveway.run_data.way import EgoWay

_NOBODY: NDArray[np.int64] = np.empty(0, dtype=np.int64)
_MOST = 2.0**53  # beyond it a number of 64 bits has no exact integers


class RecordedEgo(NamedTuple):
    """One ego's rows."""

    id: str
    shape: VehicleShape
    goal: float  # [m]
    first: int  # the control instant at which it departed
    track: EgoTrack
    predictions: PredictionTrack
    outputs: tuple[Output, ...] = ()
    hasty: NDArray[np.int64] = _NOBODY  # indices of who set out for the road too suddenly


class RecordedRows:
    """Recorded rows, from a recorder or from the journal of a run that died.

    Args:
        rows: by table, as :class:`Recorder` lays them out.
        names: what their indices mean.
    """

    def __init__(self, rows: dict[str, Array], names: dict[str, tuple[str, ...]]) -> None:
        self._rows = rows
        self._names = names
        instants = len(rows["clock"])  # rows of an instant without a row here are left out
        self.time = np.ascontiguousarray(rows["clock"][:, 0])  # (T,) [s]
        self._ego = rows["ego"][rows["ego"][:, 0] < instants]
        self._background: BackgroundTrack | None = None

    @property
    def ledger(self) -> dict[str, int]:
        """How many pedestrians were where at the latest of SUMO's instants."""
        rows = self._rows["ledger"]
        return {name: int(rows[-1, i]) for i, name in enumerate(LEDGER)} if len(rows) else {}

    def egos(self) -> Iterator[RecordedEgo]:
        """Every ego that has rows, in the order of departure."""
        for number, length, width, goal in self._rows["drives"]:
            rows = self._ego[self._ego[:, 1] == number]
            if len(rows):
                name = self._names["egos"][int(number)]
                shape = VehicleShape(float(length), float(width))
                yield RecordedEgo(
                    name,
                    shape,
                    float(goal),
                    int(rows[0, 0]),
                    self._track(rows),
                    self._predictions_of(number),
                    self._outputs_of(name, rows),
                    self._hasty_of(number),
                )

    def _track(self, rows: Array) -> EgoTrack:
        columns = [np.ascontiguousarray(column) for column in rows.T]
        word = self._words
        *texts, iterations = columns[-5:]
        words: Sequence[Any] = [word(text) for text in texts]
        numbers: Sequence[Any] = columns[2:-5]  # in EgoTrack's order
        return EgoTrack(*numbers, *words, _indices(iterations))  # type: ignore[call-arg]

    def _predictions_of(self, number: float) -> PredictionTrack:
        rows = self._rows["predictions"]
        rows = rows[(rows[:, 0] < len(self.time)) & (rows[:, 1] == number)]
        step, _, pedestrian, look_ahead, x, y = rows.T
        return PredictionTrack(
            time=self.time[_indices(step)],
            pedestrian=_indices(pedestrian),
            look_ahead=look_ahead,
            x=x,
            y=y,
        )

    def _outputs_of(self, ego: str, rows: Array) -> tuple[Output, ...]:
        """What the profile of an ego's FMU wanted to have recorded, at each of its instants."""
        recorded, found = self._rows["outputs"], list[Output]()
        for key, text in enumerate(self._names["outputs"]):
            whose, name, unit, description = json.loads(text)
            if whose == ego:
                own = recorded[recorded[:, 1] == key]
                values = np.full(len(self.time), np.nan)
                known = own[own[:, 0] < len(values)]
                values[_indices(known[:, 0])] = known[:, 2]
                found.append(Output(name, unit, description, values[_indices(rows[:, 0])]))
        return tuple(found)

    def _hasty_of(self, number: float) -> NDArray[np.int64]:
        """Who set out for the road more suddenly than an ego's safety layer assumes."""
        rows = self._rows["hasty"]
        return np.unique(_indices(rows[rows[:, 0] == number, 1]))

    def _words(self, indices: Array) -> NDArray[np.str_]:
        return np.array(self._names["words"], dtype=np.str_)[_indices(indices)]

    def crowd_track(self) -> CrowdTrack:
        """The crowd's rows as arrays."""
        rows = self._rows["crowd"]
        rows = rows[: np.searchsorted(rows[:, 0], len(self.time))]  # no copy: it may be most of RAM
        step, pedestrian, x, y, vx, vy = rows.T
        told = {name: about for name, *about in map(json.loads, self._names.get("traits", ()))}
        traits = [told.get(name, ("", "")) for name in self._names["pedestrians"]]
        return CrowdTrack(
            step=_indices(step),
            pedestrian=_indices(pedestrian),
            x=np.ascontiguousarray(x),
            y=np.ascontiguousarray(y),
            vx=np.ascontiguousarray(vx),
            vy=np.ascontiguousarray(vy),
            ids=self._names["pedestrians"],
            kinds=tuple(kind for kind, _ in traits),
            groups=tuple(group for _, group in traits),
        )

    def background_track(self) -> BackgroundTrack:
        """The background vehicles' rows as arrays, the same for the run and each ego."""
        if self._background is None:
            columns = [np.ascontiguousarray(column) for column in self._rows["background"].T]
            names = np.array(self._names["vehicles"], dtype=np.str_)
            time, vehicle, kind, *numbers = columns
            who, what = names[_indices(vehicle)], names[_indices(kind)]
            self._background = BackgroundTrack(time, who, what, *numbers)
        return self._background

    def ways(self) -> dict[str, EgoWay]:
        """The ways of those egos on whose way the law of the road has a say, by their ids."""
        ways = (EgoWay.from_dict(json.loads(text)) for text in self._names["ways"])
        return {way.ego: way for way in ways}

    def signal_track(self) -> SignalTrack:
        """The rows of traffic lights as arrays."""
        time, system, state = self._rows["signals"].T
        return SignalTrack(time.copy(), self._words(system), self._words(state))

    def people_track(self) -> PeopleTrack:
        """The rows of where people mean to walk as arrays."""
        rows = self._rows["people"]
        step, pedestrian, desired_speed, x, y = rows[rows[:, 0] < len(self.time)].T
        return PeopleTrack(
            step.astype(np.int64),
            pedestrian.astype(np.int64),
            desired_speed.copy(),
            x.copy(),
            y.copy(),
        )

    def timings(self) -> Timings:
        """The computing times as an array."""
        return Timings(self._rows["timing"].copy())


def _indices(numbers: Array) -> NDArray[np.int64]:
    """Numbers that stand for indices or counts.

    Raises:
        ValueError: one does not; a broken journal holds anything.
    """
    if not (np.abs(numbers) < _MOST).all():  # nor is nan
        raise ValueError("no index")
    return numbers.astype(np.int64)
