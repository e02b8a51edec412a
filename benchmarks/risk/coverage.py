"""Coverage of the intervals of ``giveway risk`` on problems with a known probability.

    python benchmarks/risk/coverage.py --out FOLDER          # can be ended and resumed
    python benchmarks/risk/coverage.py --out FOLDER --table  # the table alone

needs ``pip install openturns otbenchmark`` beside giveway; without them only the counter-examples
are tried. Each line of FOLDER/coverage.csv is one estimate.
"""

import argparse
import csv
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from problems import Problem, counter_examples, otbenchmark_problems

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
    parser.add_argument("--table", action="store_true")
    wanted = parser.parse_args()
    wanted.out.mkdir(parents=True, exist_ok=True)
    file = wanted.out / "coverage.csv"
    problems = [p for p in _problems() if not wanted.only or p.name in wanted.only]
    methods = wanted.method or ["subset"]
    if not wanted.table:
        _complete(file, problems, methods, wanted.budget, wanted.repeats)
    for line in table(file, problems, wanted.budget):
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


def table(file: Path, problems: list[Problem], budget: int) -> Iterator[str]:
    """Yield the lines of the table: coverage, width and doubts of each problem and method."""
    groups: defaultdict[tuple[str, str], list[dict[str, str]]] = defaultdict(list)
    for row in _rows(file):
        if row["budget"] == str(budget):
            groups[row["problem"], row["method"]].append(row)
    known = {problem.name: problem for problem in problems}
    yield "| problem | d | reference | method | mean | n | covered | in doubt | high/low | runs |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for (name, method), rows in sorted(groups.items(), key=lambda item: item[0][::-1]):
        if name not in known:
            continue
        truth = known[name].probability
        low, high, mean, runs = (
            np.array([float(row[key]) for row in rows])
            for key in ("low", "high", "probability", "runs")
        )
        covered = (low <= truth) & (truth <= high)
        doubt = np.array([bool(row["doubts"]) for row in rows])
        with np.errstate(divide="ignore"):
            ratio = float(np.median(high / low))
        bad = np.count_nonzero(~covered & ~doubt)
        yield (
            f"| {name} | {known[name].dimension} | {truth:.4g} | {method} | {mean.mean():.4g} | "
            f"{len(rows)} | {np.count_nonzero(covered)} | {np.count_nonzero(doubt)} "
            f"({bad} neither) | {ratio:.2f} | {np.median(runs):.0f} |"
        )


if __name__ == "__main__":
    main()
