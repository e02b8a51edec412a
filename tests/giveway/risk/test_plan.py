"""The plan of a risk: the run of each vector, and requests that cannot be estimated."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.errors import ConfigError, GivewayError
from giveway.risk.definition import dump_risk, make_risk, parse_risk
from giveway.risk.plan import plan_risk

CROWD = {"name": "x", "run": {"crowd": {"pedestrians": 2}, "time_limit": 1.0}}


def planned(**changes):
    return plan_risk(make_risk(CROWD | changes, "mine"), "mine")


def test_a_vector_makes_the_settings_of_its_run():
    plan = planned(inputs={"vehicle.mass": {"uniform": [900, 1100]}})
    config = plan.config(np.zeros(plan.inputs.dimension))
    assert config.vehicle.mass == 1000.0
    assert config.crowd.draws == (0.0,) * 6
    assert config.metrics.impacts


def test_the_key_of_a_run_depends_on_vector_and_settings():
    plan, other = planned(), planned(run={"crowd": {"pedestrians": 2}, "time_limit": 2.0})
    vectors = np.random.default_rng(1).standard_normal((2, plan.inputs.dimension))
    keys = {run.key for each in (plan, other) for run in each.runs(vectors, 1)}
    assert len(keys) == 4
    assert [run.id for run in plan.runs(vectors, 7)] == ["r7", "r8"]


def test_nothing_random_is_one_line():
    with pytest.raises(ConfigError, match=r"mine: nothing is random: nobody is added"):
        planned(run={"time_limit": 1.0, "crowd": {"pedestrians": 0}})


def test_an_event_without_degrees_needs_monte_carlo():
    with pytest.raises(ConfigError, match="no degrees that could guide the estimator"):
        planned(event="red-light", method="subset", runs=5000)


def test_a_budget_too_small_for_levels_is_refused():
    with pytest.raises(ConfigError, match="expected a budget of at least 3000"):
        planned(method="subset", runs=100)


def test_an_input_that_is_no_option_is_named():
    with pytest.raises(GivewayError, match=r"vehicle.*mas"):
        planned(inputs={"vehicle.mas": {"normal": [1000, 100]}})


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"method": "magic"}, "method = 'magic': should be"),
        ({"runs": 0}, "runs = 0: should be at least 1"),
        ({"evnt": "frontal"}, "evnt: unknown key; expected one of name, event"),
    ],
)
def test_a_wrong_key_of_a_risk_is_one_line(changes, said):
    with pytest.raises(ConfigError, match=said):
        planned(**changes)


def test_a_written_definition_is_read_as_it_was(tmp_path):
    risk = make_risk(CROWD | {"inputs": {"vehicle.mass": {"normal": [1000, 100]}}}, "mine")
    assert parse_risk(dump_risk(risk), "risk.toml", tmp_path) == risk
