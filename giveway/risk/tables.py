"""The tables of a risk: the estimate, its stages, all runs, those with the event, the failed."""

import math
import shlex
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd

from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.risk.cause_tables import (
    GIVEN_EVENT_COLUMNS,
    LIKELIEST_COLUMNS,
    given_event_frame,
    likeliest_frame,
)
from giveway.risk.estimators import Estimate, SobolIndex, Stage, clopper_pearson
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.severity import Severity, severities
from giveway.run_data.columns import Column
from giveway.studies.folder.frames import FAILURE_COLUMNS, measured_columns
from giveway.studies.folder.table_files import write_described
from giveway.studies.record import CRASHED

_KM = 1000.0  # m in a km
_PROBABILITIES = frozenset(
    {"probability", "low", "high", "mean", "in_a_run", "per_km", "per_km_low", "per_km_high"}
    | {"index", "index_low", "index_high"}
)
_STAGE_MEANINGS = {
    "repeat": (None, "number of the repeat"),
    "stage": (None, "number of the stage within the repeat"),
    "runs": (None, "runs of the stage"),
    "level": (None, "criticality that the next stage exceeds; 0 is the event"),
    "share": (None, "share of the runs beyond the level"),
    "step": (None, "size of the chains' steps, 0 to 1; 0: no chains"),
    "accepted": (None, "share of the chains' proposals that were accepted; 1: no chains"),
    "probability": (None, "probability to be beyond the level, by this repeat"),
}
STAGE_COLUMNS = tuple(
    Column(name, "integer" if name in {"repeat", "stage", "runs"} else "number", unit, meaning)
    for name, (unit, meaning) in _STAGE_MEANINGS.items()
)
RISK_COLUMNS = (
    Column("event", "string", None, "event whose probability is estimated"),
    Column("method", "string", None, "estimator"),
    Column("probability", "number", None, "probability of the event in one run"),
    Column("low", "number", None, "lower bound of its interval"),
    Column("high", "number", None, "upper bound of its interval; one-sided without an event"),
    Column("confidence", "number", None, "of the interval"),
    Column("distance", "number", "km", "mean distance of the egos in one run"),
    Column("per_km", "number", "1/km", "probability of the event in one run over this distance"),
    Column("per_km_low", "number", "1/km", "lower bound"),
    Column("per_km_high", "number", "1/km", "upper bound"),
    Column("runs", "integer", None, "runs that were used"),
    Column("events", "integer", None, "of these, runs with the event"),
    Column(
        "failed",
        "integer",
        None,
        "of these, runs without a result, or with an injury that is not known",
    ),
    Column(
        "doubts", "string", None, "reasons for which the interval may not hold; empty: none known"
    ),
)
SEVERITY_COLUMNS = (
    Column("curve", "string", None, "authors and year of the curve"),
    Column("outcome", "string", None, "injury: death or MAIS3+"),
    Column(
        "impacts",
        "integer",
        None,
        "frontal contacts in all runs: of an ego one adult and one child",
    ),
    Column("children", "integer", None, "of these, those with a child: outside validity"),
    Column("valid", "integer", None, "of these, those for which the curve holds"),
    Column("mean", "number", None, "mean probability of the injury in these; empty: outside"),
    Column(
        "in_a_run",
        "number",
        None,
        "probability of the injury of an adult in a run; empty: not known",
    ),
    Column("low", "number", None, "lower bound, for the number of impacts"),
    Column("high", "number", None, "upper bound, for the number of impacts"),
)
WHY_COLUMNS = (
    Column("group", "string", None, "noise (by the seed), an input, or crowd"),
    Column("first", "number", None, "share of the criticality's variance that it explains alone"),
    Column("first_low", "number", None, "lower bound"),
    Column("first_high", "number", None, "upper bound"),
    Column("total", "number", None, "share of the variance in which it takes part"),
    Column("total_low", "number", None, "lower bound"),
    Column("total_high", "number", None, "upper bound"),
    Column("used", "integer", None, "base vectors with a result in all their runs"),
)
_HEAD = (
    Column("run", "string", None, "id of the run, for giveway rerun"),
    Column("criticality", "number", None, "at least 0: the event; negative: how far from it"),
    Column("seed", "integer", None, "seed of everything that is no input of its own"),
)
_EGO = (
    Column("ego", "string", None, "SUMO id of the ego; empty without one"),
    Column("ending", "string", None, "why it ended; failed and crashed runs have no numbers"),
)
_EVENT_COLUMNS = (
    *_HEAD,
    Column("frontal_impact_speed", "number", "m/s", "largest at a frontal contact; empty: none"),
    Column("side_impact_speed", "number", "m/s", "largest at a side; empty: none"),
    Column("reproduce", "string", None, "the command that makes the run again"),
)


@dataclass(frozen=True)
class PerKilometre:
    """The probability of the event over the distance of a run.

    Attributes:
        distance: Mean distance [km] of the egos in one run; nan without a result.
        rate: Probability over this distance [1/km].
        low: Lower bound.
        high: Upper bound.
    """

    distance: float
    rate: float
    low: float
    high: float


def per_kilometre(folder: RiskFolder, estimate: Estimate) -> PerKilometre:
    """Return the probability per km, by the distance of the runs that were drawn plainly.

    The estimators' other runs are drawn near the event, and their distances are not usual ones.
    """
    plain = plain_runs(folder)
    distances = [
        sum(float(row.get("travelled_distance") or 0.0) for row in record.rows)
        for _, record in folder.runs[plain]
        if not record.failed
    ]
    distance = float(np.mean(distances)) / _KM if distances else math.nan
    numbers = (estimate.probability, estimate.low, estimate.high)
    if not distance > 0.0:
        return PerKilometre(distance, math.nan, math.nan, math.nan)
    return PerKilometre(distance, *(number / distance for number in numbers))


def plain_runs(folder: RiskFolder) -> slice:
    """Return the runs that are drawn from the inputs' own distribution."""
    definition, estimate = folder.plan.definition, folder.estimate
    if definition.method == "monte-carlo":
        return slice(None)
    if definition.method == "importance":
        return slice(0)  # all are drawn from mixtures
    first = sum(stage.runs for stage in estimate.stages if stage.stage == 1)
    ahead = estimate.runs - sum(stage.runs for stage in estimate.stages)
    return slice(ahead, ahead + first)


def write_risk_tables(folder: RiskFolder) -> None:
    """Write the tables into the risk's folder.

    Raises:
        ResultsError: the disk is full or not writable, or runs are missing.
    """
    name = folder.plan.definition.name
    tables = {
        "risk": (risk_frame(folder), RISK_COLUMNS),
        "stages": (stages_frame(folder.estimate.stages), STAGE_COLUMNS),
        "runs": (runs_frame(folder), runs_columns(folder)),
        "events": (events_frame(folder), _EVENT_COLUMNS),
        "severity": (severity_frame(folder), SEVERITY_COLUMNS),
        "why": (why_frame(folder.indices), WHY_COLUMNS),
        "given_event": (given_event_frame(folder), GIVEN_EVENT_COLUMNS),
        "likeliest": (likeliest_frame(folder), LIKELIEST_COLUMNS),
        "failures": (failures_frame(folder), FAILURE_COLUMNS),
    }
    title = f"giveway risk {name}"
    write_described(folder.path, f"giveway-risk-{name}", title, tables, _PROBABILITIES)


def risk_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``risk.csv``: the estimate in one row."""
    estimate, definition = folder.estimate, folder.plan.definition
    kilometre = per_kilometre(folder, estimate)
    row = {
        **{column.name: getattr(estimate, column.name, None) for column in RISK_COLUMNS},
        "event": definition.event,
        "method": definition.method,
        "confidence": definition.confidence,
        "distance": kilometre.distance,
        "per_km": kilometre.rate,
        "per_km_low": kilometre.low,
        "per_km_high": kilometre.high,
        "doubts": "; ".join(estimate.doubts),
    }
    return pd.DataFrame([row], columns=[column.name for column in RISK_COLUMNS])


def stages_frame(stages: Sequence[Stage]) -> pd.DataFrame:
    """Return ``stages.csv``: a row per stage."""
    names = [column.name for column in STAGE_COLUMNS]
    return pd.DataFrame([asdict(stage) for stage in stages], columns=names)


def severities_of(folder: RiskFolder) -> list[Severity]:
    """Return the injuries at the frontal contacts of all runs, by each curve."""
    return severities([row for _, record in folder.runs for row in record.rows])


def severity_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``severity.csv``: a row per curve.

    The probability in a run is known from plain runs alone, and if the curve holds for all
    contacts with adults.
    """
    plain, runs = folder.plan.definition.method == "monte-carlo", len(folder.runs)
    rows = []
    for one in severities_of(folder):
        known = plain and one.holds_for_adults
        low, high = clopper_pearson(one.valid, runs, folder.plan.definition.confidence)
        scale = one.mean if known else math.nan
        shares = {"in_a_run": one.valid / runs, "low": low, "high": high}
        rows.append({**asdict(one), **{name: share * scale for name, share in shares.items()}})
    return pd.DataFrame(rows, columns=[column.name for column in SEVERITY_COLUMNS])


def why_frame(indices: Sequence[SobolIndex]) -> pd.DataFrame:
    """Return ``why.csv``: the Sobol indices of each group of inputs."""
    rows = [asdict(one) for one in indices]
    return pd.DataFrame(rows, columns=[column.name for column in WHY_COLUMNS])


def runs_columns(folder: RiskFolder) -> tuple[Column, ...]:
    """Return the columns of ``runs.csv``."""
    declared = tuple(
        Column(
            one.name,
            _type_of(one.numbers if one.distribution == "choice" else (0.5,)),
            None,
            f"input {one.name}",
        )
        for one in folder.plan.inputs.scalars
    )
    measured = measured_columns(record for _, record in folder.runs)
    return (*_HEAD, *declared, *_EGO, *EGO_FIELDS, *measured)


def _type_of(values: Sequence[Any]) -> Any:
    numbers = all(
        isinstance(value, int | float) and not isinstance(value, bool) for value in values
    )
    return "number" if numbers else "string"


def runs_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``runs.csv``: a row per run and ego."""
    columns = runs_columns(folder)
    rows: list[dict[str, Any]] = []
    for run, record in folder.runs:
        inputs = folder.plan.inputs
        head = {
            "run": run.id,
            "criticality": folder.plan.criticality(run, record),
            "seed": inputs.settings(run.vector)["seed"],
            **inputs.values(run.vector),
        }
        rows += [head | dict(row) for row in record.rows or ({"ending": record.ending},)]
    frame = pd.DataFrame(rows, columns=[column.name for column in columns])
    numbers = {column.name: float for column in columns if column.type == "number"}
    return frame.astype(numbers).fillna({"ego": ""})


def events_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``events.csv``: the runs with the event, the worst first."""
    command = f"giveway rerun {shlex.quote(str(folder.path))}"
    frame = runs_frame(folder)
    frame = frame[frame["criticality"] >= 0.0]
    frame = frame.sort_values("criticality", ascending=False, kind="stable", ignore_index=True)
    frame["reproduce"] = [f"{command} {run}" for run in frame["run"]]
    return frame[[column.name for column in _EVENT_COLUMNS]]


def failures_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``failures.csv``: the runs without a result."""
    command = f"giveway rerun {shlex.quote(str(folder.path))}"
    rows = [
        {
            "run": run.id,
            "cell": 1,
            "seed": folder.plan.inputs.settings(run.vector)["seed"],
            "ending": record.ending or CRASHED,
            "cause": record.failure,
            "reproduce": f"{command} {run.id}",
        }
        for run, record in folder.runs
        if record.failed
    ]
    return pd.DataFrame(rows, columns=[column.name for column in FAILURE_COLUMNS])
