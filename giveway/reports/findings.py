"""A study in words: what was compared, how many runs there are, what was found.

Every sentence is made from the study's numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from giveway.reports.published import agreement, published_frame
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
    from collections.abc import Mapping, Sequence

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
    levels = _listed([_named(label) for label in treatment_labels(study)])
    compares = f"The study compares {levels} with the baseline {_named(baseline_label(study))}"
    if not levels:
        compares = f"The study has one level only, {_named(baseline_label(study))}"
    if not made:
        return f"{compares} ({compared}); there is no run yet."
    among = f" in {_count(where, 'context')}" if where > 1 else ""
    which = f"seeds {seeds[0]} to {seeds[-1]}" if len(seeds) > 1 else f"seed {seeds[0]}"
    size = f"{_count(made, 'run')} on {_count(len(seeds), 'crowd')} per cell ({which})"
    paired = "All levels met the same crowds, so that differences are taken pair by pair."
    return f"{compares} ({compared}){among}: {size}.{f' {paired}' if levels else ''}"


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
        result = (
            "nothing can be said on the completion time; a longer time_limit may help."
            if incomplete == pairs - int(frame["lost"].sum())
            else "they have no completion time, which favours a level that gets stuck."
        )
        said.append(
            f"In {incomplete:,} of {_count(pairs, 'pair')} a side did not reach its goal: {result}"
        )
    said.append(_too_few(study))
    published = published_frame(study)
    if published is not None:
        said.append(agreement(published))
    return [sentence for sentence in said if sentence]


def _too_few(study: Study) -> str:
    """Where so few pairs were compared that no difference could have been shown; or nothing."""
    frame = study.comparison[study.comparison["verdict"] != "N.A."]
    level = 1.0 - study.definition.comparison.confidence
    most = int(frame["n"].max()) if len(frame) else 0
    smallest = 2.0 ** (1 - most)  # p where all differences have one sign
    if not most or smallest <= level or frame["verdict"].isin(["better", "worse"]).any():
        return ""
    return (
        f"The signed-rank test of {most} different differences has a p-value of {smallest:.3g} or "
        f"more, however large they are, and {level:.3g} is asked for: take more seeds."
    )


def _of_metric(study: Study, name: str) -> list[str]:
    """Sentences on one metric in general: each group's, or how many are better."""
    frame = study.comparison
    frame = frame[(frame["situation"] == "general") & (frame["metric"] == name)]
    verdicts = frame["verdict"].astype(str).to_list()
    if not verdicts or all(verdict == "N.A." for verdict in verdicts):
        return []
    if len(verdicts) > IN_FULL:
        return [_counted(name, verdicts)]
    groups = frame.groupby(["treatment", "ego"], sort=False, dropna=False)
    return [_sentence(study, name, group.to_dict("records")) for _, group in groups]


def _sentence(study: Study, name: str, rows: Sequence[Mapping[Any, Any]]) -> str:
    """One treatment, all contexts: better and worse with numbers, the others by name."""
    known, baseline = metric(name), _named(baseline_label(study))
    treatment = _named(level_label(rows[0]["treatment"])) + shown_ego(level_label(rows[0]["ego"]))
    label = known.label[0].upper() + known.label[1:]
    told = []
    for verdict in ("better", "worse"):
        here = [row for row in rows if row["verdict"] == verdict]
        if here:
            side = "lower" if here[0]["mean_difference"] < 0 else "higher"
            sizes = "; ".join(_size(study, row, known.unit) for row in here)
            told.append(
                f"is {side} with {treatment} than with {baseline}, which is {verdict}: {sizes}"
            )
    rest = [row for row in rows if row["verdict"] not in {"better", "worse", "N.A."}]
    if rest:
        where = _where(study, rest)
        told.append(f"no difference between {treatment} and {baseline} is shown{where}")
    few = [row for row in rows if row["verdict"] == "N.A."]
    if few:
        told.append(f"there are too few pairs (N.A.){_where(study, few)}")
    joint = " " if told[0].startswith("is ") else ": "
    return f"{label}{joint}{'; '.join(told)}."


def _size(study: Study, row: Mapping[Any, Any], unit: str) -> str:
    """As in "by 1.62 s (95 % interval 0.91 to 2.49 s) where crowd.pedestrians = 30"."""
    low, high = row["ci_low"], row["ci_high"]
    if row["mean_difference"] < 0:
        low, high = -high, -low
    size = quantity(abs(row["mean_difference"]), unit, digits_for(high - low))
    percent = 100.0 * study.definition.comparison.confidence
    within = f"{percent:g} % interval {interval(low, high, unit)}; {_count(int(row['n']), 'pair')}"
    return f"by {size} ({within}){_where(study, [row])}"


def _where(study: Study, rows: Sequence[Mapping[Any, Any]]) -> str:
    """The contexts of some rows, as in " where crowd.pedestrians = 30 or ..."; or nothing."""
    places = {context.key: context.label for context in contexts(study)}
    labels = [places.get(context_key(study, row), "") for row in rows]
    return f" where {' or '.join(labels)}" if any(labels) else ""


def _counted(name: str, verdicts: list[str]) -> str:
    shown = [word for word in ("better", "worse") if word in verdicts]
    parts = [f"{word} in {verdicts.count(word)}" for word in shown]
    missing = verdicts.count("N.A.")
    rest = len(verdicts) - missing - sum(verdicts.count(word) for word in shown)
    parts += [f"no difference shown in {rest}"] if rest else []
    parts += [f"N.A. in {missing}"] if missing else []
    label = metric(name).label
    label = label[0].upper() + label[1:]
    return f"{label}: {', '.join(parts)} of {len(verdicts)} comparisons with the baseline."


def _overlaps(study: Study) -> list[str]:
    """In how many runs a pedestrian touched the vehicle, level by level."""
    runs = study.runs
    numbers = pd.to_numeric(runs["overlaps"], errors="coerce")
    if not (numbers > 0).any():
        never = "No pedestrian's circle ever overlapped the vehicle's rectangle."
        return [never] if numbers.notna().any() else []
    by_cell = {cell: label for context in contexts(study) for label, cell in context.cells.items()}
    level = runs["cell"].map(by_cell)
    parts = []
    for label in compared_labels(study):
        here = numbers[level == label].dropna()
        if len(here):
            count = f"{int((here > 0).sum()):,} of {_count(len(here), 'run')}"
            parts.append(f"{share(float((here > 0).mean()))} ({count}) with {_named(label)}")
    return [f"A pedestrian's circle overlapped the vehicle's rectangle in {_listed(parts)}."]


def _in_all(study: Study) -> list[str]:
    verdicts = study.comparison["verdict"].astype(str)
    enough = int((verdicts != "N.A.").sum())
    if not enough and not drives(study):
        return ["The runs have no ego: every metric is an ego's, so there is nothing to compare."]
    if not enough:
        return ["No situation has enough pairs for a comparison: every difference is N.A."]
    better, worse = int((verdicts == "better").sum()), int((verdicts == "worse").sum())
    rate = 100.0 * (1.0 - study.definition.comparison.confidence)
    return [
        f"Over all metrics and situations, {enough:,} comparisons have enough pairs: {better:,} "
        f"better, {worse:,} worse, {enough - better - worse:,} without a difference shown. "
        f"A difference counts as shown where its interval leaves out zero and the signed-rank "
        f"test agrees, at a false discovery rate of {number(rate, 0)} % over the whole study."
    ]


def drives(study: Study) -> bool:
    """Whether the runs drive an ego, as far as can be told from those with a result."""
    return bool(study.runs["mean_speed"].notna().any()) or bool(len(study.failures))


def _count(n: int, noun: str) -> str:
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


def _named(level: str) -> str:
    """A level's label in a sentence: in quotation marks if it is not a single word."""
    return level if level and not set(level) & set(" ,;:") else f"“{level}”"


def _listed(words: list[str]) -> str:
    """As in "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""
