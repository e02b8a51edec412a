"""Risks of a small crowd just ahead of a car, really run or by a formula."""

from __future__ import annotations

from types import SimpleNamespace

from giveway.metrics.impacts import ImpactMetric
from giveway.risk.definition import make_risk
from giveway.risk.plan import batches, plan_risk
from giveway.run_data.columns import columns_of
from giveway.studies.record import RunRecord

HIT_AT_ONCE = {
    "name": "small",
    "runs": 8,
    "run": {
        "time_limit": 1.0,
        "controller": "pid-paper",
        "ego": {"initial_speed": 8.0},
        "crowd": {"pedestrians": 2, "spawn_area": [3.5, -2, 9, 1], "walk": [0, 5]},
    },
    "inputs": {"vehicle.mass": {"normal": [1000, 50]}},
}


def known_risk(folder, method="monte-carlo", runs=1500, **changes):
    """Return a risk whose runs have a formula.

    Runs are the worse, the faster the ego and the heavier the car; nothing else matters.
    """
    inputs = {
        "ego.initial_speed": {"uniform": [1.0, 8.0]},
        "vehicle.mass": {"normal": [1000, 50]},
        "crowd.preset": {"choice": ["MIXED", "SIM"]},
    }
    values = HIT_AT_ONCE | {"inputs": inputs, "method": method, "runs": runs} | changes
    plan = plan_risk(make_risk(values, "mine"), "mine")
    asking, made = batches(plan), []
    try:
        batch = next(asking)
        while True:
            records = [_by_formula(run) for run in batch]
            made += zip(batch, records, strict=True)
            batch = asking.send(records)
    except StopIteration as end:
        found = end.value
    return SimpleNamespace(
        path=folder,
        plan=plan,
        runs=made[: found.estimate.runs],
        estimate=found.estimate,
        indices=found.indices,
    )


def _by_formula(run):
    beyond = 0.8 * float(run.vector[1]) + 0.6 * float(run.vector[2]) - 1.3
    row = {
        "ego": "ego",
        "ending": "completed",
        "travelled_distance": 50.0,
        "minimum_clearance": max(0.0, -beyond),
        "frontal_impact_speed": 10.0 * beyond if beyond >= 0.0 else None,
        "adult_impact_speed": 10.0 * beyond if beyond >= 0.0 else None,
    }
    return RunRecord(
        run.id, run.key, "completed", rows=(row,), columns=columns_of(ImpactMetric.Columns)
    )
