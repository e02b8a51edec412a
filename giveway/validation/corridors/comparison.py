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

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.geometry.kernel import Array
from giveway.recordings import Recording
from giveway.validation.behaviour.comparison import DRAWS, RECORDED, SIMULATED
from giveway.validation.behaviour.corridor import FREE_SPEEDS
from giveway.validation.behaviour.replaying import settled
from giveway.validation.corridors.geometry import StraightCorridor, corridor_of
from giveway.validation.corridors.replaying import LONGER, free_speeds, replayed_in

BAR = 0.15
"""Largest relative difference to the recording that is good enough."""
BIN = 0.5
"""Width [/m^2] of the bins of density."""
_MIDDLE = (0.375, 0.625)  # Ends of the measurement area, as shares of the corridor's length
_WINDOW = 1.0  # Time [s] over which density and speed are averaged
_LEAST_WINDOWS, _LEAST_PEOPLE = 5, 10  # Numbers below which there is no speed, and no comparison


@dataclass(frozen=True, eq=False)
class InCorridors:
    """The comparison of simulated with recorded people in corridors.

    Attributes:
        read: Number of recordings, also of those that are left out.
        free: Speed [m/s] that each recorded person shows while free; nan for most.
        windows: Density and speed in each second, with columns who, density, speed.
        flows: Flow [/s] by the names of the recordings, with columns recorded, simulated.
    """

    read: int
    free: Array
    windows: pd.DataFrame
    flows: pd.DataFrame

    @property
    def speeds(self) -> pd.DataFrame:
        """The mean speed in each bin of density, with columns recorded, simulated."""
        bins = (self.windows["density"] / BIN).astype(int).rename("bin")
        found = self.windows.groupby([bins, "who"])["speed"].agg(["mean", "size"])
        mean = found["mean"].where(found["size"] >= _LEAST_WINDOWS).unstack("who")
        return mean.reindex(columns=[RECORDED, SIMULATED])

    @property
    def table(self) -> pd.DataFrame:
        """The table: a row per bin of density that the recording has, and one per flow."""
        speeds = self.speeds.dropna(subset=RECORDED)
        speeds.index = [f"{BIN * k:g} to {BIN * (k + 1):g} /m^2" for k in speeds.index]
        parts = {("speed", "m/s"): speeds, ("flow", "1/s"): self.flows}
        table = pd.concat(parts, names=["measure", "unit", "of"]).reset_index()
        table["difference"] = table[SIMULATED] / table[RECORDED] - 1.0
        table["within_bar"] = table["difference"].abs() <= BAR
        return table


def compare_in_corridors(
    recordings: Sequence[Recording],
    config: RunConfig,
    advance: Callable[[str], None] = lambda _name: None,
    *,
    draws: int = DRAWS,
    speeds: tuple[float, float] = FREE_SPEEDS,
) -> InCorridors:
    """Simulate the people of recordings in corridors, and compare the two.

    Args:
        recordings: Recordings from :func:`giveway.recordings.read_recordings`.
        config: Configuration that names the pedestrian model and its preset.
        advance: Function that is called with the name of each recording that is done.
        draws: Number of times that people are simulated.
        speeds: Mean and deviation [m/s] of the desired speeds of people who show none.

    Raises:
        ConfigError: the data set has no corridor.
        DatasetError: there are vehicles, or too few people in corridors.
    """
    pairs = [(corridor_of(each), settled(each)) for each in recordings]
    chosen = [(way, each) for way, each in pairs if way is not None and not each.vehicles.ids]
    people = sum(len(each.people.ids) for _, each in chosen)
    if people < _LEAST_PEOPLE:
        raise DatasetError(
            f"recordings: {people} people in {len(chosen)} corridors without vehicles, of "
            f"{len(recordings)} recordings; expected at least {_LEAST_PEOPLE}, and names as in "
            "[corridor] of the description; giveway data describe lists people and vehicles"
        )
    drawn = dict(zip(("desired_speed_mean", "desired_speed_sd"), speeds, strict=True))
    config = config.model_copy(update={"crowd": config.crowd.model_copy(update=drawn)})
    windows, flows = [], {}
    for corridor, each in chosen:
        table, flow = measured(corridor, each, each.frames)
        replays = [replayed_in(corridor, each, config, draw) for draw in range(draws)]
        found = [measured(corridor, replay, round(LONGER * each.frames)) for replay in replays]
        windows += [table.assign(who=RECORDED), *(one.assign(who=SIMULATED) for one, _ in found)]
        flows[each.name] = {RECORDED: flow, SIMULATED: np.mean([one for _, one in found])}
        advance(each.name)
    return InCorridors(
        len(recordings),
        np.concatenate([free_speeds(*pair) for pair in chosen]),
        pd.concat(windows, ignore_index=True),
        pd.DataFrame.from_dict(flows, orient="index"),
    )


def measured(
    corridor: StraightCorridor, recording: Recording, frames: int
) -> tuple[pd.DataFrame, float]:
    """Return density [/m^2] and speed [m/s] in each second, and the flow [/s] through the exit.

    The flow is nan if fewer than two people get out.

    Args:
        corridor: Corridor.
        recording: Recorded or simulated people.
        frames: Number of instants until which people may get out.
    """
    people = recording.people
    along = corridor.along(people.position)
    low, high = (share * corridor.length for share in _MIDDLE)
    entered = people.frame[people.bounds[:-1]].max(initial=0)
    inside = (along >= low) & (along < high) & (people.frame <= entered)
    length = max(1, round(_WINDOW * recording.frame_rate))
    speed = pd.Series(people.velocity[inside] @ np.array(corridor.direction))
    windows = speed.groupby(people.frame[inside] // length).agg(["size", "mean"])
    area = (high - low) * corridor.width
    table = pd.DataFrame({"density": windows["size"] / length / area, "speed": windows["mean"]})
    beyond = along >= corridor.length
    out = pd.Series(people.frame[beyond]).groupby(people.track[beyond]).min()
    end = out.max() if len(out) == len(people.ids) else frames
    flow = (len(out) - 1) / (end - out.min()) if len(out) > 1 and end > out.min() else np.nan
    return table, float(flow * recording.frame_rate)
