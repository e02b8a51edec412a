"""Fit the pedestrian model from several starts: docs/validation.md's table of what data determine.

    python benchmarks/tuning/fit_spread.py CITR_FOLDER DUT_FOLDER --dataset citr --dataset dut \
        --out FITS --evaluations 602

Each seed is a fit of ``giveway calibrate --seed``. The folder keeps one journal of values per seed,
so that the same command goes on after a kill, and goes further with more evaluations. A finished
fit costs nothing when the table is printed again.
"""

import argparse
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

from giveway.geometry.kernel import Array
from giveway.recordings import dataset_of, read_recordings
from giveway.validation.behaviour.comparison import Yardstick
from giveway.validation.behaviour.objective import Objective
from giveway.validation.behaviour.search import DEFAULT, Found, Journal, Search
from pedestrian_model import PRESETS, VciParameters, Vehicles, vehicle_influence

_IDENTIFIED = 0.2  # Largest standard deviation of the logarithm of a parameter that is identified

_CORRELATED = 0.63  # Correlation that 5 % of unrelated pairs exceed in ten fits
_FRONT, _SIDE = 2.25, 0.9  # Distances [m] from the middle of a car to its front and its side
_CAR = Vehicles(np.array([[0.0, 0.0, 0.0, 3.0, _FRONT, _FRONT, 2.0 * _SIDE]]))  # at 3 m/s
_AWAY = np.arange(0.05, 20.0, 0.01)  # Distances [m] from the car that are tried


def fitted(sites: list[Yardstick], seed: int, evaluations: int, folder: Path) -> Found:
    """Return the fit of one seed, after the values that its journal keeps."""
    start = PRESETS["SIM"]
    search = Search(Objective(sites), start, seed=seed, evaluations=evaluations)
    settings = start, seed, [(site.names, site.floors) for site in sites]
    return search.run(Journal(folder / f"seed_{seed}.journal", settings))


def spread(fits: list[VciParameters], preset: VciParameters) -> pd.DataFrame:
    """Return a row per parameter: its values over the fits, and whether the data determine it.

    Args:
        fits: Parameters of each fit.
        preset: Parameters of the preset beside them.
    """
    values = pd.DataFrame(map(_numbers, fits))
    table = values.quantile([0.5, 0.25, 0.75, 0.0, 1.0]).T
    table.columns = ["median", "quarter", "three quarters", "least", "most"]
    table.insert(0, "preset", pd.Series(_numbers(preset)))
    table["deviation"] = np.log(values).std(ddof=1)
    table["identified"] = table["deviation"] <= _IDENTIFIED
    return table


def _numbers(parameters: VciParameters) -> dict[str, float]:
    """Return the fitted parameters, and how far a car's force reaches that follows from some."""
    ahead = np.column_stack([_FRONT + _AWAY, np.full_like(_AWAY, 0.5)])
    beside = np.column_stack([np.zeros_like(_AWAY), _SIDE + _AWAY])
    return {f"`{name}`": getattr(parameters, name) for name in DEFAULT} | {
        "reach ahead [m]": _reach(parameters, ahead),
        "reach beside [m]": _reach(parameters, beside),
    }


def _reach(parameters: VciParameters, places: Array) -> float:
    """Return the distance [m] within which a car lets people accelerate as hard as they can."""
    forces = vehicle_influence(places, np.zeros_like(places), _CAR, parameters)[0]
    hard = np.hypot(*forces.T) >= parameters.mass * parameters.max_acceleration
    return float(_AWAY[hard].max(initial=_AWAY[0]))


def correlated(fits: list[VciParameters]) -> str:
    """Return the pairs of parameters whose logarithms are correlated over the fits, as one line."""
    logarithms = np.log(pd.DataFrame(map(_numbers, fits))[[f"`{name}`" for name in DEFAULT]])
    matrix = logarithms.corr()
    pairs = [(matrix.loc[pair], pair) for pair in combinations(matrix.columns, 2)]
    told = [f"{' and '.join(pair)} {r:.2f}" for r, pair in sorted(pairs) if abs(r) > _CORRELATED]
    return f"{len(told)} of {len(pairs)} pairs beyond {_CORRELATED}: {', '.join(told)}."


def printed(table: pd.DataFrame) -> str:
    """Return the table of ``spread`` as Markdown; the rows that are best determined come first."""
    heads = "| | `MIXED` | median | quartiles | range | deviation | identified |"
    lines = [heads, "|---" * 7 + "|"]
    for name, row in table.sort_values("deviation").iterrows():
        number = [np.format_float_positional(v, 3, fractional=False, trim="-") for v in row[:6]]
        lines.append(
            f"| {name} | {number[0]} | {number[1]} | {number[2]} to {number[3]} | {number[4]} to "
            f"{number[5]} | {row['deviation']:.2f} | {'yes' if row['identified'] else 'no'} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Fit from each start, then print the table and the value of each fit."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", type=Path, nargs="+", help="folders of the recordings")
    parser.add_argument("--dataset", action="append", required=True, help="of each folder")
    parser.add_argument("--out", type=Path, required=True, help="folder of the journals")
    parser.add_argument("--fits", type=int, default=10, help="number of starts, seeds 1 on")
    parser.add_argument("--evaluations", type=int, default=602, help="of each fit")
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    places = zip(chosen.folders, chosen.dataset, strict=True)
    sites = [Yardstick(read_recordings(folder, dataset_of(name))) for folder, name in places]
    found = []
    for seed in range(1, chosen.fits + 1):
        found.append(fitted(sites, seed, chosen.evaluations, chosen.out))
        print(f"seed {seed}: value {found[-1].value:.2f}", flush=True)
    fits = [each.parameters for each in found]
    print(printed(spread(fits, PRESETS["MIXED"])))
    print(correlated(fits))
    values = ", ".join(f"{each:.2f}" for each in sorted(each.value for each in found))
    print(f"Values: {values}; of the preset today {Objective(sites)(PRESETS['MIXED']):.2f}.")


if __name__ == "__main__":
    main()
