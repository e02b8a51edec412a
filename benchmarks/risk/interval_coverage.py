"""Coverage of the intervals of ``giveway risk`` on problems with a known probability.

    python benchmarks/risk/interval_coverage.py --out FOLDER    # can be ended and resumed
    python benchmarks/risk/interval_coverage.py --out FOLDER --table --keep FILE.csv

needs ``pip install openturns otbenchmark`` beside giveway; without them only the counter-examples
are tried. Each line of FOLDER/coverage.csv is one estimate.
"""

import argparse
import csv
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np
from known_probabilities import Problem, counter_examples, otbenchmark_problems

from giveway.risk.estimators import (
    Estimate,
    importance_sampling,
    monte_carlo,
    run_sampler,
    subset_simulation,
)

METHODS = ("monte-carlo", "subset", "importance")
COLUMNS = ("problem", "method", "budget", "repeat", "probability", "low", "high", "runs", "doubts")


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--repeats", type=int, default=100)
    parser.add_argument("--budget", type=int, default=20_000)
    parser.add_argument("--method", choices=METHODS, action="append")
    parser.add_argument("--only", action="append", help="name of a problem")
    parser.add_argument("--table", action="store_true", help="make nothing")
    parser.add_argument("--keep", type=Path, help="CSV file for the summary, kept beside this one")
    wanted = parser.parse_args()
    wanted.out.mkdir(parents=True, exist_ok=True)
    file = wanted.out / "coverage.csv"
    problems = [p for p in _problems() if not wanted.only or p.name in wanted.only]
    methods = wanted.method or ["subset"]
    if not wanted.table:
        _complete(file, problems, methods, wanted.budget, wanted.repeats)
    rows = list(summary(file, problems))
    if wanted.keep is not None:
        keep(rows, wanted.keep)
    for line in table(rows):
        print(line)


def _problems() -> list[Problem]:
    try:
        return otbenchmark_problems() + counter_examples()
    except ImportError as error:
        sys.stderr.write(f"note: {error}; the counter-examples alone are tried\n")
        return counter_examples()


def _complete(
    file: Path, problems: list[Problem], methods: list[str], budget: int, repeats: int
) -> None:
    done = {(row["problem"], row["method"], row["budget"], row["repeat"]) for row in _rows(file)}
    new = not file.exists()
    with file.open("a", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        if new:
            writer.writerow(COLUMNS)
        for repeat in range(repeats):
            for problem in problems:
                for method in methods:
                    key = (problem.name, method, str(budget), str(repeat))
                    if key in done:
                        continue
                    one = estimate(problem, method, budget, repeat)
                    numbers = (one.probability, one.low, one.high, one.runs)
                    writer.writerow([*key, *map(repr, numbers), " | ".join(one.doubts)])
                    stream.flush()


def estimate(problem: Problem, method: str, budget: int, seed: int) -> Estimate:
    """Return one estimate of a problem's probability."""
    dimension = problem.dimension
    sampler = {
        "monte-carlo": lambda: monte_carlo(dimension, budget, np.random.default_rng(seed)),
        "subset": lambda: subset_simulation(dimension, budget, seed),
        "importance": lambda: importance_sampling(dimension, budget, seed),
    }[method]()
    return run_sampler(sampler, problem.criticality)


def _rows(file: Path) -> list[dict[str, str]]:
    if not file.exists():
        return []
    with file.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@dataclass(frozen=True)
class Row:
    """The coverage of one problem by one method.

    Attributes:
        problem: Name of the problem.
        dimension: Number of inputs.
        source: Probability by the source.
        truth: Probability that is to be covered, by an integral where there is one.
        method: Estimator.
        budget: Its budget.
        repeats: Number of estimates.
        mean: Mean of the estimates.
        covered: Number of intervals that cover the truth.
        source_covered: Number of intervals that cover the source's probability.
        doubts: Number of estimates that say that the interval may not hold.
        silent: Number of estimates that neither cover the truth nor say so.
        ratio: Median of upper over lower bound.
        runs: Median number of runs.
    """

    problem: str
    dimension: int
    source: float
    truth: float
    method: str
    budget: int
    repeats: int
    mean: float
    covered: int
    source_covered: int
    doubts: int
    silent: int
    ratio: float
    runs: int


def summary(file: Path, problems: list[Problem]) -> Iterator[Row]:
    """Yield the coverage of each problem and method."""
    groups: defaultdict[tuple[str, str, str], list[dict[str, str]]] = defaultdict(list)
    for row in _rows(file):
        groups[row["method"], row["budget"], row["problem"]].append(row)
    known = {problem.name: problem for problem in problems}
    for (method, budget, name), rows in sorted(groups.items()):
        if name not in known:
            continue
        problem = known[name]
        low, high, mean, runs = (
            np.array([float(row[key]) for row in rows])
            for key in ("low", "high", "probability", "runs")
        )
        covered = (low <= problem.truth) & (problem.truth <= high)
        source = (low <= problem.probability) & (problem.probability <= high)
        doubt = np.array([bool(row["doubts"]) for row in rows])
        with np.errstate(divide="ignore"):
            ratio = float(np.median(high / low))
        yield Row(
            name,
            problem.dimension,
            problem.probability,
            problem.truth,
            method,
            int(budget),
            len(rows),
            float(mean.mean()),
            int(covered.sum()),
            int(source.sum()),
            int(doubt.sum()),
            int(np.count_nonzero(~covered & ~doubt)),
            ratio,
            int(np.median(runs)),
        )


def keep(rows: list[Row], file: Path) -> None:
    """Write the summary as a CSV file."""
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(field.name for field in fields(Row))
        for row in rows:
            values = astuple(row)
            writer.writerow(f"{v:.4g}" if isinstance(v, float) else v for v in values)


def table(rows: list[Row]) -> Iterator[str]:
    """Yield the lines of the table in docs/risk.md."""
    heads = (
        "problem | inputs | probability | method | budget | covered | doubted | neither | high/low"
    )
    yield f"| {heads} |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        yield (
            f"| {row.problem} | {row.dimension} | {row.truth:.3g} | {row.method} | "
            f"{row.budget:,} | {row.covered} | {row.doubts} | {row.silent} | {row.ratio:.2f} |"
        )


if __name__ == "__main__":
    main()
