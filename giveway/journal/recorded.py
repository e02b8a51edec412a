"""The recorded rows of a run, from a recorder or a journal, and as tracks."""

import json
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.journal.journal import Array
from giveway.journal.layout import EGO_COUNTS, EGO_NUMBERS, EGO_TEXTS, ROWS, STORED
from giveway.journal.stored_crowd import StoredCrowd
from giveway.journal.stored_rows import Rows, StoredRows
from giveway.run_data.outputs import Output
from giveway.run_data.rows import LEDGER
from giveway.run_data.tracks import (
    COORDINATES,
    NEVER,
    BackgroundTrack,
    CrowdTrack,
    EgoTrack,
    PeopleTrack,
    PredictionTrack,
    SightTrack,
    SignalTrack,
    Timings,
    as_indices,
)
from giveway.run_data.way import EgoWay

_NOBODY: NDArray[np.int64] = np.empty(0, dtype=np.int64)


class RecordedEgo(NamedTuple):
    """The rows of one ego."""

    id: str
    shape: VehicleShape
    goal: float  # [m] distance that it is to drive
    first: int  # control instant at which it departed
    track: EgoTrack
    predictions: PredictionTrack
    outputs: tuple[Output, ...] = ()
    hasty: NDArray[np.int64] = _NOBODY  # indices of people whose sudden start broke the assumption


class RecordedRows:
    """Recorded rows, from a recorder or from the journal of a run that died.

    Args:
        rows: Rows of each table, with the columns of :data:`giveway.journal.layout.ROWS`.
        names: Strings to which the indices in the rows refer.
    """

    def __init__(
        self, rows: Mapping[str, Rows | StoredRows], names: dict[str, tuple[str, ...]]
    ) -> None:
        self._crowd = rows[STORED]
        self._rows = {k: part for k, part in rows.items() if not isinstance(part, StoredRows)}
        self._names = names
        clock, ego = self._rows["clock"], self._rows["ego"]
        self.time = np.ascontiguousarray(clock["time"])  # (T,) [s] control instants
        self._ego = ego[ego["step"] < len(clock)]  # the last instant may lack rows
        self._background: BackgroundTrack | None = None

    @property
    def ledger(self) -> dict[str, int]:
        """Return the ledger of pedestrians at SUMO's latest instant."""
        rows = self._rows["ledger"]
        return {name: int(rows[name][-1]) for name in LEDGER} if len(rows) else {}

    def egos(self) -> Iterator[RecordedEgo]:
        """Yield every ego that has rows, in the order of departure."""
        for number, length, width, goal in self._rows["drives"]:
            rows = self._ego[self._ego["ego"] == number]
            if len(rows):
                name = self._names["egos"][int(number)]
                shape = VehicleShape(float(length), float(width))
                yield RecordedEgo(
                    name,
                    shape,
                    float(goal),
                    int(rows["step"][0]),
                    self._track(rows),
                    self._predictions_of(number),
                    self._outputs_of(name, rows),
                    self._hasty_of(number),
                )

    def _track(self, rows: Rows) -> EgoTrack:
        columns: dict[str, Any] = {
            name: as_indices(rows[name]) if name in EGO_COUNTS else np.ascontiguousarray(rows[name])
            for name in EGO_NUMBERS
        }
        texts = {name: self._words(rows[name]) for name in EGO_TEXTS}
        return EgoTrack(**columns | texts)

    def _predictions_of(self, number: float) -> PredictionTrack:
        rows = self._rows["predictions"]
        rows = rows[(rows["step"] < len(self.time)) & (rows["ego"] == number)]
        return PredictionTrack(
            time=self.time[as_indices(rows["step"])],
            pedestrian=as_indices(rows["pedestrian"]),
            look_ahead=rows["look_ahead"],
            x=rows["x"],
            y=rows["y"],
        )

    def _outputs_of(self, ego: str, rows: Rows) -> tuple[Output, ...]:
        """Return the values (T,) of the outputs that the profile of an ego's FMU lists."""
        recorded, found = self._rows["outputs"], list[Output]()
        for key, text in enumerate(self._names["outputs"]):
            whose, name, unit, description = json.loads(text)
            if whose == ego:
                own = recorded[recorded["output"] == key]
                values = np.full(len(self.time), np.nan)
                known = own[own["step"] < len(values)]
                values[as_indices(known["step"])] = known["value"]
                found.append(Output(name, unit, description, values[as_indices(rows["step"])]))
        return tuple(found)

    def _hasty_of(self, number: float) -> NDArray[np.int64]:
        """Return the pedestrians who broke the safety layer's assumption by a sudden start."""
        rows = self._rows["hasty"]
        return np.unique(as_indices(rows["pedestrian"][rows["ego"] == number]))

    def _words(self, indices: Array) -> NDArray[np.str_]:
        return np.array(self._names["words"], dtype=np.str_)[as_indices(indices)]

    def crowd_track(self) -> CrowdTrack:
        """Return the crowd's rows as arrays, or a track that reads them if there are too many."""
        told = {name: about for name, *about in map(json.loads, self._names.get("traits", ()))}
        traits = [told.get(name, ("", "")) for name in self._names["pedestrians"]]
        about: dict[str, Any] = {
            "ids": self._names["pedestrians"],
            "kinds": tuple(kind for kind, _ in traits),
            "groups": tuple(group for _, group in traits),
            "reacts_from": self._reacts_from(),
        }
        rows, instants = self._crowd, len(self.time)
        if isinstance(rows, StoredRows):
            return StoredCrowd(rows, 0, instants, about)
        # a view, which needs no memory
        rows = rows[: np.searchsorted(rows["step"], instants)]
        about |= {name: np.ascontiguousarray(rows[name]) for name in COORDINATES}
        about |= {name: as_indices(rows[name]) for name in ("step", "pedestrian")}
        return CrowdTrack(**about)

    def _reacts_from(self) -> NDArray[np.int64] | None:
        """Return the instant (n,) from which each pedestrian reacts; None if all always do."""
        rows = self._rows["reacting"]
        if not len(rows):
            return None
        first = np.zeros(len(self._names["pedestrians"]), dtype=np.int64)
        first[as_indices(rows["pedestrian"])] = NEVER
        reacts = rows[rows["reacts"] > 0.0]
        first[as_indices(reacts["pedestrian"])] = as_indices(reacts["step"])
        return first

    def background_track(self) -> BackgroundTrack:
        """Return the background vehicles' rows as arrays, the same for the run and each ego."""
        if self._background is None:
            rows, names = self._rows["background"], np.array(self._names["vehicles"], dtype=np.str_)
            columns: dict[str, Any] = {
                name: np.ascontiguousarray(rows[name]) for name in ROWS["background"]
            }
            texts = {name: names[as_indices(columns[name])] for name in ("id", "type")}
            self._background = BackgroundTrack(**columns | texts)
        return self._background

    def ways(self) -> dict[str, EgoWay]:
        """Return the path of each ego on which the law rules anything, by the ego's id."""
        ways = (EgoWay.from_dict(json.loads(text)) for text in self._names["ways"])
        return {way.ego: way for way in ways}

    def signal_track(self) -> SignalTrack:
        """Return the rows of traffic lights as arrays."""
        rows = self._rows["signals"]
        system, state = self._words(rows["system"]), self._words(rows["state"])
        return SignalTrack(time=rows["time"].copy(), system=system, state=state)

    def sight_track(self) -> SightTrack:
        """Return the rows of who is in sight as arrays."""
        rows, egos = self._rows["sights"], np.array(self._names["egos"], dtype=np.str_)
        return SightTrack(
            time=rows["time"].copy(),
            ego=egos[as_indices(rows["ego"])],
            pedestrian=as_indices(rows["pedestrian"]),
            seen=rows["seen"] > 0.0,
            distance=rows["distance"].copy(),
        )

    def people_track(self) -> PeopleTrack:
        """Return the rows of people's planned routes as arrays."""
        rows = self._rows["people"]
        rows = rows[rows["step"] < len(self.time)]
        return PeopleTrack(
            step=rows["step"].astype(np.int64),
            pedestrian=rows["pedestrian"].astype(np.int64),
            **{name: rows[name].copy() for name in ("desired_speed", "x", "y")},
        )

    def timings(self) -> Timings:
        """Return the computing times as an array."""
        rows = self._rows["timing"]
        return Timings(np.column_stack([rows[name] for name in Timings.NAMES]))
