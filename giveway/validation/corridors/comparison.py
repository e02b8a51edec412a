"""The comparison of simulated with recorded people in corridors: speed per density, and flow.

Density is the classic one: people in the middle quarter of the corridor over its size, averaged
over one second, until the last person has entered. The speed is the mean along the corridor of the
same people in the same second. The flow through the exit is that between the first and the last
person. If not all of them get out, it is that up to the end of the replay.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.geometry.kernel import Array
from giveway.recordings import Recording
from giveway.validation.behaviour.replaying import settled
from giveway.validation.corridors.geometry import StraightCorridor, corridor_of
from giveway.validation.corridors.replaying import LONGER, free_speeds, replayed_in

BAR = 0.15
"""Largest relative difference to the recording that is good enough."""
BIN = 0.5
"""Width [/m^2] of the bins of density."""
DRAWS = 5
"""Number of times that people are simulated."""
_MIDDLE = (0.375, 0.625)  # Ends of the measurement area, as shares of the corridor's length
_WINDOW = 1.0  # Time [s] over which density and speed are averaged
_FEWEST = 5  # Number of windows below which a bin has no speed
_PEOPLE = 10  # Number of people in all recordings, below which there is no comparison


@dataclass(frozen=True, eq=False)
class Walked:
    """The measures of recorded or simulated people in corridors.

    Attributes:
        density: Density (w,) [/m^2] of each window of a second with somebody in the area.
        speed: Mean speed (w,) [m/s] along the corridor in each of them.
        flow: Flow (r,) [/s] through the exit of each recording; nan if fewer than two get out.
    """

    density: Array
    speed: Array
    flow: Array

    def speeds(self, bins: int) -> Array:
        """Return the mean speed (bins,) [m/s] in each bin of density; nan with few windows."""
        which = (self.density / BIN).astype(np.int64)
        count = np.bincount(which, minlength=bins)[:bins]
        total = np.bincount(which, self.speed, minlength=bins)[:bins]
        return np.where(count >= _FEWEST, total / np.maximum(count, 1), np.nan)


@dataclass(frozen=True, eq=False)
class Comparison:
    """The comparison of simulated with recorded people in corridors.

    Attributes:
        names: Name (r,) of each recording.
        left_out: Number of recordings whose names are not those of a corridor's.
        people: Number of people.
        free: Speeds (f,) [m/s] that recorded people show while free.
        recorded: Measures of recorded people.
        simulated: Measures of simulated people, of all draws; flows are means of the draws.
    """

    names: tuple[str, ...]
    left_out: int
    people: int
    free: Array
    recorded: Walked
    simulated: Walked

    @property
    def bins(self) -> int:
        """The number of bins of density that the recording reaches."""
        return 1 + int(self.recorded.density.max(initial=0.0) / BIN)

    @property
    def table(self) -> pd.DataFrame:
        """The table: a row per bin of density that the recording has, and one per flow."""
        both = [each.speeds(self.bins) for each in (self.recorded, self.simulated)]
        rows = [
            ("speed", f"{BIN * k:g} to {BIN * (k + 1):g} /m^2", "m/s", both[0][k], both[1][k])
            for k in np.flatnonzero(~np.isnan(both[0]))
        ]
        flows = zip(self.names, self.recorded.flow, self.simulated.flow, strict=True)
        rows += [("flow", name, "1/s", *flow) for name, *flow in flows]
        table = pd.DataFrame(rows, columns=["measure", "of", "unit", "recorded", "simulated"])
        table["difference"] = table["simulated"] / table["recorded"] - 1.0
        table["within_bar"] = table["difference"].abs() <= BAR
        return table

    @property
    def points(self) -> pd.DataFrame:
        """The points of the fundamental diagram: a row per window of a second."""
        found = {"recorded": self.recorded, "simulated": self.simulated}
        return pd.concat(
            [
                pd.DataFrame({"who": who, "density": each.density, "speed": each.speed})
                for who, each in found.items()
            ],
            ignore_index=True,
        )


def compare_in_corridors(
    recordings: Sequence[Recording],
    config: RunConfig,
    advance: Callable[[str], None] = lambda _name: None,
    draws: int = DRAWS,
) -> Comparison:
    """Simulate the people of recordings in corridors, and compare the two.

    Args:
        recordings: Recordings from :func:`giveway.recordings.read_recordings`.
        config: Configuration of the crowd: model, preset, and desired speeds.
        advance: Function that is called with the name of each recording that is done.
        draws: Number of times that people are simulated.

    Raises:
        ConfigError: the data set has no corridor.
        DatasetError: no recording is one of a corridor, or there are vehicles or too few people.
    """
    pairs = [(corridor_of(each), settled(each)) for each in recordings]
    chosen = [(corridor, each) for corridor, each in pairs if corridor is not None]
    _require_people([each for _, each in chosen], len(recordings))
    free = np.concatenate([free_speeds(corridor, each) for corridor, each in chosen])
    recorded, simulated = [], []
    for corridor, each in chosen:
        recorded.append(measured(corridor, each, each.frames))
        frames = round(LONGER * each.frames)
        replays = (replayed_in(corridor, each, config, draw) for draw in range(draws))
        simulated.append(_together([measured(corridor, replay, frames) for replay in replays]))
        advance(each.name)
    return Comparison(
        names=tuple(each.name for _, each in chosen),
        left_out=len(recordings) - len(chosen),
        people=sum(len(each.people.ids) for _, each in chosen),
        free=free[~np.isnan(free)],
        recorded=_joined(recorded),
        simulated=_joined(simulated),
    )


def _require_people(recordings: Sequence[Recording], read: int) -> None:
    if not recordings:
        raise DatasetError(
            f"recordings: none of {read} has a name of a corridor; expected one like names in "
            "[corridor] of the data set's description; rename the files, or correct names"
        )
    for each in recordings:
        if each.vehicles.ids:
            raise DatasetError(
                f"{each.file}: {len(each.vehicles.ids)} vehicles; expected people alone in a "
                "corridor; giveway data behave compares people near vehicles"
            )
    people = sum(len(each.people.ids) for each in recordings)
    if people < _PEOPLE:
        raise DatasetError(
            f"recordings: {people} people in corridors; expected at least {_PEOPLE}; "
            "giveway data describe lists people"
        )


def measured(corridor: StraightCorridor, recording: Recording, frames: int) -> Walked:
    """Return density, speed and flow of the people in a corridor.

    Args:
        corridor: Corridor.
        recording: Recorded or simulated people.
        frames: Number of instants until which people may get out.
    """
    people = recording.people
    along = corridor.along(people.position)
    low, high = (share * corridor.length for share in _MIDDLE)
    entered = people.frame[people.bounds[:-1]].max()
    inside = (along >= low) & (along < high) & (people.frame <= entered)
    length = max(1, round(_WINDOW * recording.frame_rate))
    window = people.frame[inside] // length
    count = np.bincount(window)
    total = np.bincount(window, people.velocity[inside] @ np.array(corridor.direction))
    seen = count > 0
    density = count[seen] / length / ((high - low) * corridor.width)
    out = _got_out(recording, along >= corridor.length)
    end = out[-1] if len(out) == len(people.ids) else float(frames)
    flow = (len(out) - 1) / (end - out[0]) if len(out) > 1 and end > out[0] else np.nan
    return Walked(density, total[seen] / count[seen], np.array([flow * recording.frame_rate]))


def _got_out(recording: Recording, beyond: NDArray[np.bool_]) -> Array:
    """Return the instants (m,) at which people are behind the exit for the first time, sorted."""
    people = recording.people
    first = np.full(len(people.ids), np.inf)
    np.minimum.at(first, people.track[beyond], people.frame[beyond])
    return np.sort(first[np.isfinite(first)])


def _together(draws: Sequence[Walked]) -> Walked:
    """Return the windows of all draws of a recording, and its mean flow."""
    all_draws = _joined(draws)
    return Walked(all_draws.density, all_draws.speed, np.array([all_draws.flow.mean()]))


def _joined(parts: Sequence[Walked]) -> Walked:
    columns = (np.concatenate(each) for each in zip(*map(_columns, parts), strict=True))
    return Walked(*columns)


def _columns(found: Walked) -> tuple[Array, Array, Array]:
    return found.density, found.speed, found.flow
