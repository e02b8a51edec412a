"""The trained numbers of ``drift``, with their provenance.

``trained.npz`` has the arrays and ``trained.toml`` their origin. Both are written by
``benchmarks/prediction/train_drift.py``. There are several fits: FILTERED is for the filtered
velocities of recordings, EXACT for the exact ones of a run. The others are fitted without one site,
on which they can be judged.
"""

import tomllib
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache, cached_property
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from pedestrian_model.drift.forest import Forest, Trees, masked

FILTERED, EXACT = "filtered", "exact"
ARRAYS, PROVENANCE = "trained.npz", "trained.toml"
_PACKAGE = "pedestrian_model.drift"


@dataclass(frozen=True, eq=False)
class Fit:
    """One fit of the trees.

    Attributes:
        name: Name of the fit.
        clips: Names of the clips on which it was fitted.
        forest: Trees.
        deviation: Coefficients (3, 2, 2) of the spread; see
            :func:`pedestrian_model.drift.motion.spread`.
        baseline: Coefficients (3, 3, 2, 2) of the spread of constant velocity by the file's
            velocity, by positions, and by the mean of both.
    """

    name: str
    clips: frozenset[str]
    forest: Forest
    deviation: NDArray[np.float64]
    baseline: NDArray[np.float64]

    @cached_property
    def trees(self) -> Trees:
        """The trees as the compiled sum takes them."""
        return masked(self.forest)


@cache
def fits() -> dict[str, Fit]:
    """Return all fits by name."""
    folder = resources.files(_PACKAGE)
    origin = tomllib.loads((folder / PROVENANCE).read_text(encoding="utf-8"))
    with (folder / ARRAYS).open("rb") as file, np.load(file, allow_pickle=False) as arrays:
        return {
            name: _fit(name, frozenset(told["clips"]), {k: arrays[f"{name}.{k}"] for k in _PARTS})
            for name, told in origin["fits"].items()
        }


_PARTS = ("feature", "value", "below", "roots", "start", "deviation", "baseline")


def _fit(name: str, clips: frozenset[str], parts: dict[str, NDArray[np.generic]]) -> Fit:
    whole = {part: parts[part].astype(np.int64) for part in ("feature", "below", "roots")}
    real = {part: parts[part].astype(np.float64) for part in _PARTS if part not in whole}
    forest = Forest(whole["feature"], real["value"], whole["below"], whole["roots"], real["start"])
    return Fit(name, clips, forest, real["deviation"], real["baseline"])


def unseen_fit(clips: Collection[str]) -> Fit | None:
    """Return the fit for recordings that has seen none of the clips, or None if each has seen one.

    Of several fits it is the one with the most clips.

    Args:
        clips: Names of the clips to be predicted.
    """
    able = [fit for fit in fits().values() if fit.name != EXACT and fit.clips.isdisjoint(clips)]
    return max(able, key=lambda fit: len(fit.clips), default=None)
