"""The command ``giveway calibrate`` fits parameters of the model to recorded trajectories."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from giveway.config.files.presets import NAMES, require_parameter
from giveway.errors import ConfigError, DatasetError
from giveway.recordings.intervals import TAILS, ClipBootstrap
from giveway.validation.clips import Clip
from giveway.validation.contacts import DATA, contact_table, people_apart
from giveway.validation.fitting import Objective, Search, average
from giveway.validation.predictors import VCI
from giveway.validation.protocol import Protocol
from giveway.validation.validating import SEED, cut_windows, protocol_of
from pedestrian_model import LONGEST_STEP, ParameterError, VciParameters, require_steady

DEFAULT = (
    "destination_gain",
    "repulsion_strength",
    "navigation_strength",
    "vehicle_strength",
    "vehicle_lookahead",
)
"""Parameters that are fitted by default: the gain of each sub-force, and the vehicle's reach."""


class HeldOut(NamedTuple):
    """The choice of the clips that a fit does not use."""

    share: float = 0.3  # share of the clips, equal in each kind of clip
    seed: int = 0  # seed of the choice


HELD_OUT = HeldOut()


@dataclass(frozen=True)
class Fit:
    """An error [m] before and after the fit, and the difference with its interval.

    Attributes:
        difference: Difference after minus before; negative where the fit is better.
        low, high: Clip-bootstrap interval of the difference; nan with fewer than two clips.
    """

    before: float
    after: float
    difference: float
    low: float
    high: float

    @property
    def improves(self) -> bool:
        """True if the fit is better by more than the choice of clips explains."""
        return self.high < 0.0


@dataclass(frozen=True, eq=False)
class Calibration:
    """The result of a fit.

    Attributes:
        fitted: Names of the parameters that were free.
        training, held_out: Names of the clips.
        train, test: Objective on each; ``test`` is nan without held-out clips.
        touching: Numbers (before, after) of pedestrians that touch a vehicle in replays of all
            clips.
        apart: Smallest distance [m] between two people's centres, in the data and in replays
            of all clips (before, after).
        at_bound: Parameters that ended at the end of their range.
        evaluations: Evaluations of the objective.
        converged: True if the optimiser converged within the evaluations.
    """

    start: VciParameters
    parameters: VciParameters
    fitted: tuple[str, ...]
    training: tuple[str, ...]
    held_out: tuple[str, ...]
    train: Fit
    test: Fit
    touching: tuple[int, int]
    apart: tuple[float, float, float]
    at_bound: tuple[str, ...]
    evaluations: int
    converged: bool


def calibrate(
    clips: Sequence[Clip],
    start: VciParameters,
    names: Sequence[str] = DEFAULT,
    *,
    held_out: HeldOut = HELD_OUT,
    own_pace: bool = True,
    evaluations: int = 400,
    progress: Callable[[int, int, float], None] = lambda _done, _all, _best: None,
) -> Calibration:
    """Fit the parameters ``names`` to some of the clips, and judge them on the others.

    Args:
        clips: Clips from :func:`giveway.validation.read_clips`.
        start: Start of the search; parameters that are not named stay.
        names: Fields of :class:`VciParameters`.
        held_out: Clips that the fit does not use.
        own_pace: True: each pedestrian's desired speed is the present speed; False: the
            parameters'.
        evaluations: Evaluations of the objective, at most.
        progress: Function of evaluations done, their limit, and the least error so far.

    Raises:
        ConfigError: a name is no parameter's or cannot be fitted, or people would tremble by the
            parameters at the start.
        DatasetError: too few clips are there, or none is long enough.
    """
    names = _checked(names, start)
    try:
        require_steady(start, LONGEST_STEP)
    except ParameterError as error:
        raise ConfigError(f"--preset: {error}; start from another one, like SIM") from error
    protocol = protocol_of(clips)
    train, test = split(clips, *held_out)
    judge = partial(_judged, protocol=protocol, own_pace=own_pace)
    objective = Objective(cut_windows(train, protocol), protocol, len(train), own_pace=own_pace)
    search = Search(objective, start, names, evaluations, progress)
    best = search.run()
    before = people_apart(clips, start, protocol)
    return Calibration(
        start=start,
        parameters=best,
        fitted=names,
        training=tuple(clip.name for clip in train),
        held_out=tuple(clip.name for clip in test),
        train=judge(train, start, best),
        test=judge(test, start, best),
        touching=(_touching(clips, start, protocol), _touching(clips, best, protocol)),
        apart=(before[DATA], before[VCI], people_apart(clips, best, protocol)[VCI]),
        at_bound=search.at_bound,
        evaluations=search.done,
        converged=search.converged,
    )


def split(
    clips: Sequence[Clip], held_out: float, seed: int
) -> tuple[tuple[Clip, ...], tuple[Clip, ...]]:
    """Return training and held-out clips; each kind has a held-out clip before any has a second.

    A clip's kind is its name without the number at the end.

    Raises:
        DatasetError: there are too few clips to hold some out.
        ConfigError: ``held_out`` is not a share.
    """
    if not 0.0 <= held_out < 1.0:
        raise ConfigError(
            f"--held-out {held_out}: expected a share from 0 to less than 1 of the clips"
        )
    count = max(1, round(held_out * len(clips))) if held_out else 0
    if count >= len(clips):
        raise DatasetError(
            f"clips: {len(clips)} is too few to hold {count} out; expected more, or --held-out 0"
        )
    rank: dict[str, int] = {}
    order: list[tuple[int, int, int]] = []
    for i in np.random.default_rng(seed).permutation(len(clips)):
        kind = clips[i].name.rstrip("0123456789")
        order.append((rank.get(kind, 0), len(order), int(i)))
        rank[kind] = rank.get(kind, 0) + 1
    chosen = {i for _, _, i in sorted(order)[:count]}
    train = tuple(clip for i, clip in enumerate(clips) if i not in chosen)
    return train, tuple(clip for i, clip in enumerate(clips) if i in chosen)


def _checked(names: Sequence[str], start: VciParameters) -> tuple[str, ...]:
    for name in names:
        require_parameter(name, "--parameters")
        if names.count(name) > 1:
            raise ConfigError(f"--parameters: {name} is named twice; expected once")
        if getattr(start, name) == 0.0:
            raise ConfigError(
                f"--parameters: {name} starts at 0 and is scaled from there; start elsewhere"
            )
    if not names:
        raise ConfigError(f"--parameters: expected at least one of {', '.join(NAMES)}")
    return tuple(names)


def _judged(
    clips: tuple[Clip, ...],
    start: VciParameters,
    best: VciParameters,
    *,
    protocol: Protocol,
    own_pace: bool,
) -> Fit:
    """Return both errors, and the interval of their difference for the same draws of clips."""
    if not clips:
        return Fit(math.nan, math.nan, math.nan, math.nan, math.nan)
    cut = cut_windows(clips, protocol)
    objective = Objective(cut, protocol, len(clips), own_pace=own_pace)
    before, count = objective.per_clip(start)
    after, _ = objective.per_clip(best)
    weights = ClipBootstrap.of(len(clips), SEED).weights
    low = high = math.nan
    if len(clips) > 1:
        with np.errstate(divide="ignore", invalid="ignore"):
            apart = np.nanmean((weights @ (after - before)) / (weights @ count), axis=1)
        low, high = np.nanquantile(apart, TAILS)
    means = average(before, count), average(after, count)
    return Fit(*means, means[1] - means[0], float(low), float(high))


def _touching(clips: Sequence[Clip], parameters: VciParameters, protocol: Protocol) -> int:
    """Count the pedestrians that touch a vehicle when the model replays whole clips."""
    table = contact_table(clips, parameters, protocol)
    return int(table.loc[table["predictor"] == VCI, "touching"].sum())
