"""The table of the benchmark: what each controller does in each scene, close passes first.

Means and shares are ratios of two sums over drives. Their intervals are percentiles of a bootstrap,
of which one sample is everything that belongs to one seed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway._version import __version__
from giveway.geometry.kernel import Array
from giveway.run_data.columns import Column
from giveway.studies.benchmark.definition import ALL_SCENES, VERSION, scenes
from giveway.studies.definition import Comparison
from giveway.studies.design import Design
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.lock import BENCHMARK
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics.bootstrap import seed_of
from giveway.studies.statistics.pairs import without_result
from giveway.studies.statistics.rounding import tabulated
from giveway.studies.table_columns import numbers_of

FILE = BENCHMARK
"""Name of the table in the study's folder."""


class _Ratio(NamedTuple):
    """A ratio of two sums over drives.

    Attributes:
        column: Name, unit and meaning in the table.
        top: Column of the summary that is added up above.
        bottom: Column below; empty for the number of drives that have a number above.
        bounded: True if the ends of an interval belong to it.
    """

    column: Column
    top: str
    bottom: str = ""
    bounded: bool = False


_PER_DRIVE = "people per drive whom the ego"
_RATIOS = (
    _Ratio(
        Column("close_pass_share", "number", None, "people passed closely, of those near"),
        "close_passes",
        "people_near",
        bounded=True,
    ),
    _Ratio(
        Column("close_pass_share_moving", "number", None, "the same, of those near a moving ego"),
        "close_passes",
        "people_near_moving",
        bounded=True,
    ),
    _Ratio(
        Column("close_passes", "number", None, f"{_PER_DRIVE} passes closely"),
        "close_passes",
        bounded=True,
    ),
    _Ratio(Column("tight_passes", "number", None, f"{_PER_DRIVE} passes tightly"), "tight_passes"),
    _Ratio(
        Column("narrow_passes", "number", None, f"{_PER_DRIVE} passes narrowly"), "narrow_passes"
    ),
    _Ratio(
        Column("people_delay", "number", "s", "mean over drives of the people's mean delay"),
        "mean_people_delay",
        bounded=True,
    ),
    _Ratio(Column("conflicts", "number", None, "serious conflicts per drive"), "conflicts"),
    _Ratio(
        Column("time", "number", "s", "time to the goal; without arrival, the drive's length"),
        "time",
        bounded=True,
    ),
    _Ratio(Column("hard_brakes", "number", None, "hard brakings per drive"), "hard_brakes"),
    _Ratio(Column("rms_jerk", "number", "m/s^3", "mean over drives of the RMS jerk"), "rms_jerk"),
)
_COUNTS = {
    "arrived": Column("arrived", "integer", None, "drives that reached the goal"),
    "people_near": Column("people_near", "integer", None, "people within 4 m, all drives"),
    "people_near_moving": Column(
        "people_near_moving", "integer", None, "people within 4 m of a moving ego, all drives"
    ),
    "frontal_contacts": Column("frontal_contacts", "integer", None, "in all drives"),
    "side_contacts": Column("side_contacts", "integer", None, "in all drives"),
}


def _columns() -> Iterator[Column]:
    yield Column("benchmark", "integer", None, "version of scenes, people and seeds")
    yield Column("made_with", "string", None, "version of giveway, and its commit if it is known")
    yield Column("controller", "string", None, "controller that drove")
    yield Column("people", "string", None, "parameters by which people walk")
    yield Column("scene", "string", None, f"scene, or '{ALL_SCENES}'")
    yield Column("drives", "integer", None, "drives with a result")
    yield Column("failed", "integer", None, "drives without a result")
    yield from _COUNTS.values()
    for ratio in _RATIOS:
        yield ratio.column
        if ratio.bounded:
            for end, name in (("lower", "low"), ("upper", "high")):
                meaning = f"{end} end of its 95 % interval; empty: too few drives"
                yield Column(f"{ratio.column.name}_{name}", "number", ratio.column.unit, meaning)


COLUMNS = tuple(_columns())
"""Columns of the table."""


def benchmark_table(runs: pd.DataFrame, design: Design, comparison: Comparison) -> pd.DataFrame:
    """Return a row for each controller, people and scene, and one for all scenes together.

    Args:
        runs: Table with a row per drive, as ``runs.csv``. If some scenes are left out, there is no
            row for all scenes.
        design: Design of a study of :func:`benchmark_of`.
        comparison: Confidence of the intervals. Fewer seeds than ``minimum_pairs`` have none.
    """
    runs = _with_times(runs)
    levels = {factor.name: factor.levels for factor in design.factors}
    rows: list[dict[str, object]] = []
    for controller, people in product(levels["controller"], levels["people"]):
        driven = (runs["controller"] == controller.value) & (runs["people"] == people.value)
        for scene, drives in _by_scene(runs[driven]):
            row: dict[str, object] = {
                "benchmark": VERSION,
                "made_with": f"giveway {__version__}",
                "controller": Path(controller.label).name,
                "people": people.label,
                "scene": scene,
            }
            draws = _drawn(drives, [str(name) for name in row.values()], comparison)
            rows.append(row | _numbers(drives, draws, comparison.confidence))
    frame = pd.DataFrame(rows, columns=[column.name for column in COLUMNS])
    return tabulated(frame, numbers_of(COLUMNS))


def _by_scene(runs: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yield the drives of each scene, and then those of all scenes if none is left out."""
    names = [scene for scene in scenes() if (runs["scene"] == scene).any()]
    for name in names:
        yield name, runs[runs["scene"] == name]
    if len(names) == len(scenes()):
        yield ALL_SCENES, runs


def write_benchmark(study: StudyFolder) -> pd.DataFrame:
    """Write the table into the study's folder, and return it.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    frame = benchmark_table(study.runs, study.design, study.definition.comparison)
    write_atomically(study.path / FILE, frame.to_csv(index=False, lineterminator="\n"))
    return frame


def _with_times(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the runs with the column ``time``, and with numbers for flags."""
    runs = runs.copy()
    runs["time"] = runs["completion_time"].fillna(runs["simulated_time"])
    runs["arrived"] = runs["completed"].astype(float)
    return runs


def _drawn(
    drives: pd.DataFrame, names: Sequence[str], comparison: Comparison
) -> NDArray[np.int32] | None:
    """Return the indices (resamples, n) of drawn seeds, or None if the seeds are too few.

    Args:
        drives: Rows of ``runs.csv``.
        names: Words that identify the drives, from which the draws follow.
        comparison: Number of resamples, and least number of seeds.
    """
    seeds = drives["seed"][~without_result(drives)].nunique()
    if seeds < comparison.minimum_pairs:
        return None
    rng = np.random.default_rng(seed_of(names))
    return rng.integers(0, seeds, (comparison.resamples, seeds), dtype=np.int32)


def _numbers(
    drives: pd.DataFrame, draws: NDArray[np.int32] | None, confidence: float
) -> dict[str, object]:
    """Return the numbers of a row.

    Args:
        drives: Rows of ``runs.csv``.
        draws: Indices (resamples, n) of drawn seeds, or None for no intervals.
        confidence: Probability that an interval covers the ratio.
    """
    lost = without_result(drives)
    known = drives[~lost]
    found: dict[str, object] = {"drives": len(known), "failed": int(lost.sum())}
    found |= {name: int(known[name].sum()) for name in _COUNTS}
    for column, top, bottom, bounded in _RATIOS:
        counted = known[bottom] if bottom else known[top].notna().astype(float)
        above = _by_seed(known[top], known["seed"])
        below = _by_seed(counted, known["seed"])
        found[column.name] = above.sum() / below.sum() if below.any() else np.nan
        if bounded and draws is not None:
            low, high = _interval((above, below), draws, confidence)
            if bottom and not above.any():
                high = _most_unseen(below.sum(), confidence)
            found |= {f"{column.name}_low": low, f"{column.name}_high": high}
    return found


def _by_seed(values: pd.Series[float], seeds: pd.Series[int]) -> Array:
    """Return the sum of the values of each seed."""
    return np.asarray(values.groupby(seeds).sum(), dtype=np.float64)


def _interval(
    sums: tuple[Array, Array], draws: NDArray[np.int32], confidence: float
) -> tuple[float, float]:
    """Return both ends of the interval of a ratio of sums.

    Args:
        sums: Numbers (n,) above and below, one of each seed.
        draws: Indices (resamples, n) of the drawn seeds.
        confidence: Probability that the interval covers the ratio.
    """
    above, below = sums
    with np.errstate(invalid="ignore", divide="ignore"):
        ratios = above[draws].sum(axis=1) / below[draws].sum(axis=1)
    ratios = ratios[np.isfinite(ratios)]
    if not ratios.size:
        return np.nan, np.nan
    tail = 50.0 * (1.0 - confidence)
    low, high = np.percentile(ratios, (tail, 100.0 - tail))
    return float(low), float(high)


def _most_unseen(people: float, confidence: float) -> float:
    """Return the largest share that n people may hide of whom none was passed closely.

    It is the upper end of the interval of Clopper and Pearson (1934) for independent people.
    """
    return float(1.0 - (0.5 * (1.0 - confidence)) ** (1.0 / people)) if people else np.nan
