"""A study in sentences: what was compared, the number of runs, the findings.

Every sentence follows from the study's numbers.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from giveway.reports.labels import (
    baseline_label,
    compared_labels,
    context_key,
    contexts,
    level_label,
    treatment_labels,
)
from giveway.reports.tables.published import agreement, published_frame
from giveway.reports.wording import (
    counted,
    digits_for,
    interval,
    number,
    quantity,
    quantity_of,
    share,
    shown_ego,
)
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics import confirmatory, metric

METRICS_IN_WORDS = (
    "completion_time",
    "longest_wait",
    "rms_jerk",
    "close_passes",
    "minimum_clearance",
)
# Largest number of sentences on a metric; further groups are counted in one
MOST_SENTENCES = 4


def lead(study: StudyFolder) -> str:
    """Return the sentence on what was compared, and on how many crowds."""
    runs = study.runs
    compared = study.definition.comparison.factor
    seeds = sorted(set(runs["seed"]))
    made = int(runs["run"].nunique())
    where = len(contexts(study))
    levels = _listed([_quoted(label) for label in treatment_labels(study)])
    compares = f"The study compares {levels} with the baseline {_quoted(baseline_label(study))}"
    if not levels:
        compares = f"The study has one level only, {_quoted(baseline_label(study))}"
    if not made:
        return f"{compares} ({compared}); there is no run yet."
    among = f" in {counted(where, 'context')}" if where > 1 else ""
    which = f"seeds {seeds[0]} to {seeds[-1]}" if len(seeds) > 1 else f"seed {seeds[0]}"
    size = f"{counted(made, 'run')} on {counted(len(seeds), 'crowd')} per cell ({which})"
    paired = "All levels met the same crowds, so that differences are taken pair by pair."
    return f"{compares} ({compared}){among}: {size}.{f' {paired}' if levels else ''}"


def facts(study: StudyFolder) -> list[tuple[str, str]]:
    """Return the size of the study as labels and numbers."""
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


def findings(study: StudyFolder) -> list[str]:
    """Return the main results, the most important first."""
    sentences = [primary_outcome(study)] if study.definition.primary_outcome else []
    sentences += [sentence for name in METRICS_IN_WORDS for sentence in _of_metric(study, name)]
    sentences += _overlaps(study)
    sentences += _overall(study)
    return sentences


def primary_outcome(study: StudyFolder) -> str:
    """Return the sentences on the primary outcome: which differences are confirmatory."""
    outcome = study.definition.primary_outcome
    if outcome is None:
        return (
            "The study names no primary outcome ([primary_outcome] in its file): all its "
            "differences are exploratory."
        )
    known, rows = metric(outcome.metric), confirmatory(study.comparison, study.definition)
    shown = int(rows["verdict"].isin(["better", "worse"]).sum())
    smaller = rows["smaller_effects"].value_counts()
    least = quantity_of(outcome.smallest_effect, known.unit)
    return (
        f"Primary outcome: {known.label} ({outcome.situation}). The study has "
        f"{counted(len(rows), 'confirmatory difference')}, of which {shown} "
        f"{'is' if shown == 1 else 'are'} shown after Holm's correction. Effects smaller than "
        f"{least}, the smallest of interest ({outcome.reason}), are excluded by the interval of "
        f"{smaller.get('excluded', 0)}, and no larger ones are possible in "
        f"{smaller.get('only these', 0)}. All other differences are exploratory."
    )


def cautions(study: StudyFolder) -> list[str]:
    """Return the remarks that a reader needs to judge the findings."""
    sentences = []
    failed = len(study.failures)
    if failed:
        were = "run has" if failed == 1 else "runs have"
        sentences.append(f"{failed:,} {were} no result; their pairs are left out (see Failures).")
    frame = study.situations
    incomplete = int(frame["incomplete"].sum()) if len(frame) else 0
    if incomplete:
        pairs = int(frame["pairs"].sum())
        result = (
            "nothing can be said on the completion time; a longer time_limit may help."
            if incomplete == pairs - int(frame["lost"].sum())
            else "they have no completion time, which favours a level that gets stuck."
        )
        sentences.append(
            f"In {incomplete:,} of {counted(pairs, 'pair')} a side did not reach its goal: {result}"
        )
    sentences.append(_too_few(study))
    if study.definition.primary_outcome is None and len(study.comparison):
        sentences.append(primary_outcome(study))
    published = published_frame(study)
    if published is not None:
        sentences.append(agreement(published))
    return [sentence for sentence in sentences if sentence]


def _too_few(study: StudyFolder) -> str:
    """Return a sentence if the pairs are too few to show any difference."""
    frame = study.comparison[study.comparison["verdict"] != "N.A."]
    level = 1.0 - study.definition.comparison.confidence
    most = int(frame["n"].max()) if len(frame) else 0
    smallest = 2.0 ** (1 - most)  # p-value if all differences have one sign
    if not most or smallest <= level or frame["verdict"].isin(["better", "worse"]).any():
        return ""
    return (
        f"The signed-rank test of {most} different differences has a p-value of {smallest:.3g} or "
        f"more, however large they are, and {level:.3g} is asked for: take more seeds."
    )


def _of_metric(study: StudyFolder, name: str) -> list[str]:
    """Return sentences on one metric in the general situation: one per group, or the counts."""
    frame = study.comparison
    frame = frame[(frame["situation"] == "general") & (frame["metric"] == name)]
    verdicts = frame["verdict"].astype(str).to_list()
    if not verdicts or all(verdict == "N.A." for verdict in verdicts):
        return []
    if len(verdicts) > MOST_SENTENCES:
        return [_counted(name, verdicts)]
    groups = frame.groupby(["treatment", "ego"], sort=False, dropna=False)
    return [_sentence(study, name, group.to_dict("records")) for _, group in groups]


def _sentence(study: StudyFolder, name: str, rows: Sequence[Mapping[Any, Any]]) -> str:
    """Return a sentence on one treatment: contexts with a difference by number, others by name."""
    known, baseline = metric(name), _quoted(baseline_label(study))
    treatment = _quoted(level_label(rows[0]["treatment"])) + shown_ego(level_label(rows[0]["ego"]))
    label = known.label[0].upper() + known.label[1:]
    clauses = []
    for verdict in ("better", "worse"):
        here = [row for row in rows if row["verdict"] == verdict]
        if here:
            side = "lower" if here[0]["mean_difference"] < 0 else "higher"
            sizes = "; ".join(_size(study, row, known.unit) for row in here)
            clauses.append(
                f"is {side} with {treatment} than with {baseline}, which is {verdict}: {sizes}"
            )
    rest = [row for row in rows if row["verdict"] not in {"better", "worse", "N.A."}]
    if rest:
        where = _where(study, rest)
        clauses.append(f"no difference between {treatment} and {baseline} is shown{where}")
    few = [row for row in rows if row["verdict"] == "N.A."]
    if few:
        clauses.append(f"there are too few pairs (N.A.){_where(study, few)}")
    separator = " " if clauses[0].startswith("is ") else ": "
    return f"{label}{separator}{'; '.join(clauses)}."


def _size(study: StudyFolder, row: Mapping[Any, Any], unit: str) -> str:
    """Return "by 1.62 s (95 % interval 0.91 to 2.49 s) where crowd.pedestrians = 30"."""
    low, high = row["ci_low"], row["ci_high"]
    if row["mean_difference"] < 0:
        low, high = -high, -low
    size = quantity(abs(row["mean_difference"]), unit, digits_for(high - low))
    percent = 100.0 * study.definition.comparison.confidence
    within = f"{percent:g} % interval {interval(low, high, unit)}; {counted(int(row['n']), 'pair')}"
    return f"by {size} ({within}){_where(study, [row])}"


def _where(study: StudyFolder, rows: Sequence[Mapping[Any, Any]]) -> str:
    """Return the contexts of some rows, as in " where crowd.pedestrians = 30 or ...", or ""."""
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


def _overlaps(study: StudyFolder) -> list[str]:
    """Return in how many runs a pedestrian touched the vehicle, level by level."""
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
            count = f"{int((here > 0).sum()):,} of {counted(len(here), 'run')}"
            parts.append(f"{share(float((here > 0).mean()))} ({count}) with {_quoted(label)}")
    return [f"A pedestrian's circle overlapped the vehicle's rectangle in {_listed(parts)}."]


def _overall(study: StudyFolder) -> list[str]:
    verdicts = study.comparison["verdict"].astype(str)
    enough = int((verdicts != "N.A.").sum())
    if not enough and not _have_ego(study):
        return ["The runs have no ego: every metric is an ego's, so there is nothing to compare."]
    if not enough:
        wanted, most = study.definition.comparison.minimum_pairs, int(study.comparison["n"].max())
        return [
            f"Intervals need {counted(wanted, 'pair')}, and no situation has more than {most}: the "
            f"comparison has means alone. {wanted - most} more seeds would do where every seed "
            "gives a pair (--resume --runs)."
        ]
    better, worse = int((verdicts == "better").sum()), int((verdicts == "worse").sum())
    rate = 100.0 * (1.0 - study.definition.comparison.confidence)
    return [
        f"Over all metrics and situations, {enough:,} comparisons have enough pairs: {better:,} "
        f"better, {worse:,} worse, {enough - better - worse:,} without a difference shown. "
        f"A difference counts as shown where its interval leaves out zero and the signed-rank "
        f"test agrees, at a false discovery rate of {number(rate, 0)} % over the whole study."
    ]


def _have_ego(study: StudyFolder) -> bool:
    """Return whether the runs have an ego, judging by those with a result."""
    return bool(study.runs["mean_speed"].notna().any()) or bool(len(study.failures))


def _quoted(level: str) -> str:
    """Return a level's label for a sentence: in quotation marks if it is not a single word."""
    return level if level and not set(level) & set(" ,;:") else f"“{level}”"


def _listed(words: list[str]) -> str:
    """Return words joined as in "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""
