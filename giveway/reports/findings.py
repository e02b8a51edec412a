"""A study in words: what was compared, how many runs there are, what was found.

Every sentence is made from the study's numbers.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pandas as pd

from giveway.reports.beside import agreement, published_frame
from giveway.reports.study import (
    baseline_label,
    compared_labels,
    context_key,
    contexts,
    level_label,
    treatment_labels,
)
from giveway.reports.wording import digits_for, interval, number, quantity, share, shown_ego
from giveway.studies.statistics import metric

if TYPE_CHECKING:
    from collections.abc import Mapping

    from giveway.reports.study import Study

TOLD = ("completion_time", "longest_wait", "rms_jerk", "minimum_clearance")
IN_FULL = 4  # groups up to which each has a sentence of its own


def lead(study: Study) -> str:
    """What was compared, on how many crowds."""
    runs = study.runs
    compared = study.definition.comparison.factor
    seeds = sorted(set(runs["seed"]))
    made = int(runs["run"].nunique())
    where = len(contexts(study))
    levels = _listed(treatment_labels(study))
    if not made:
        return f"The study compares {compared}: {levels} with {baseline_label(study)}; no run yet."
    return (
        f"The study compares {levels} with the baseline {baseline_label(study)} ({compared}) in "
        f"{_count(where, 'context')}: {made:,} runs on {_count(len(seeds), 'crowd')} per cell "
        f"(seeds {seeds[0]} to {seeds[-1]}). All levels met the same crowds, so that differences "
        "are taken pair by pair."
    )


def facts(study: Study) -> list[tuple[str, str]]:
    """The study's size at a glance."""
    runs = study.runs
    failed = len(study.failures)
    pairs = int(study.situations["pairs"].sum()) if len(study.situations) else 0
    return [
        ("runs", f"{runs['run'].nunique():,}"),
        ("cells", f"{len(study.design.cells):,}"),
        ("crowds per cell", f"{runs['seed'].nunique():,}"),
        ("pairs", f"{pairs:,}"),
        ("without a result", f"{failed:,}"),
    ]


def findings(study: Study) -> list[str]:
    """The main results, most important first."""
    said = [sentence for name in TOLD for sentence in _of_metric(study, name)]
    said += _overlaps(study)
    said += _in_all(study)
    return said


def cautions(study: Study) -> list[str]:
    """What a reader has to know before believing the findings."""
    said = []
    failed = len(study.failures)
    if failed:
        were = "run has" if failed == 1 else "runs have"
        said.append(f"{failed:,} {were} no result; their pairs are left out (see Failures).")
    frame = study.situations
    incomplete = int(frame["incomplete"].sum()) if len(frame) else 0
    if incomplete:
        pairs = int(frame["pairs"].sum())
        said.append(
            f"In {incomplete:,} of {pairs:,} pairs one side did not reach its goal: they have no "
            "completion time, which favours a level that gets stuck."
        )
    published = published_frame(study)
    if published is not None:
        said.append(agreement(published))
    return [sentence for sentence in said if sentence]


def _of_metric(study: Study, name: str) -> list[str]:
    """Sentences on one metric in general: each group's, or how many are better."""
    frame = study.comparison
    frame = frame[(frame["situation"] == "general") & (frame["metric"] == name)]
    verdicts = frame["verdict"].astype(str).to_list()
    if not verdicts or all(verdict == "N.A." for verdict in verdicts):
        return []
    if len(verdicts) > IN_FULL:
        return [_counted(name, verdicts)]
    places = {context.key: context.label for context in contexts(study)}
    said = []
    for row in frame.to_dict("records"):
        place = places.get(context_key(study, row), "")
        said.append((f"{place}: " if place else "") + _sentence(study, name, row))
    return said


def _sentence(study: Study, name: str, row: Mapping[Any, Any]) -> str:
    quantity_ = metric(name)
    baseline = baseline_label(study)
    treatment = level_label(row["treatment"]) + shown_ego(level_label(row["ego"]))
    mean, low, high = row["mean_difference"], row["ci_low"], row["ci_high"]
    pairs = _count(int(row["n"]), "pair")
    if row["verdict"] == "N.A." or not math.isfinite(mean):
        return f"{quantity_.label}, {treatment} against {baseline}: N.A. ({pairs})."
    percent = 100.0 * study.definition.comparison.confidence
    digits = digits_for(high - low)
    within = f"{percent:g} % interval {interval(low, high, quantity_.unit)}; {pairs}"
    if row["verdict"] not in {"better", "worse"}:
        return (
            f"no difference in {quantity_.label} is shown between {treatment} and {baseline} "
            f"({quantity(mean, quantity_.unit, digits)}; {within})."
        )
    side = "lower" if mean < 0 else "higher"
    size = quantity(abs(mean), quantity_.unit, digits)
    return (
        f"{quantity_.label} with {treatment} is {side} than with {baseline} by {size} on average, "
        f"which is {row['verdict']} ({within})."
    )


def _counted(name: str, verdicts: list[str]) -> str:
    counts = [(word, verdicts.count(word)) for word in ("better", "worse", "N.A.")]
    rest = len(verdicts) - sum(count for _, count in counts)
    parts = [f"{word} in {count}" for word, count in counts[:2]] + [
        f"no difference shown in {rest}"
    ]
    parts += [f"N.A. in {counts[2][1]}"] if counts[2][1] else []
    label = metric(name).label
    return f"{label}: {', '.join(parts)} of {len(verdicts)} comparisons with the baseline."


def _overlaps(study: Study) -> list[str]:
    """In how many runs a pedestrian touched the vehicle, level by level."""
    runs = study.runs
    numbers = pd.to_numeric(runs["overlaps"], errors="coerce")
    if not (numbers > 0).any():
        return (
            ["No pedestrian's circle ever overlapped the vehicle's rectangle."]
            if len(numbers.dropna())
            else []
        )
    by_cell = {cell: label for context in contexts(study) for label, cell in context.cells.items()}
    level = runs["cell"].map(by_cell)
    parts = []
    for label in compared_labels(study):
        here = numbers[level == label].dropna()
        if len(here):
            parts.append(f"{share(float((here > 0).mean()))} of the runs with {label}")
    return [f"A pedestrian's circle overlapped the vehicle's rectangle in {_listed(parts)}."]


def _in_all(study: Study) -> list[str]:
    verdicts = study.comparison["verdict"].astype(str)
    enough = int((verdicts != "N.A.").sum())
    if not enough:
        return ["No situation has enough pairs for a comparison: every difference is N.A."]
    better, worse = int((verdicts == "better").sum()), int((verdicts == "worse").sum())
    rate = 100.0 * (1.0 - study.definition.comparison.confidence)
    return [
        f"Over all metrics and situations, {enough:,} comparisons have enough pairs: {better:,} "
        f"better, {worse:,} worse, {enough - better - worse:,} without a difference shown. "
        f"Verdicts count on a false discovery rate of {number(rate, 0)} %."
    ]


def _count(n: int, noun: str) -> str:
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


def _listed(words: list[str]) -> str:
    """As in "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""
