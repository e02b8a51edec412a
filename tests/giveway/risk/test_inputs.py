"""The random inputs: what a vector makes of them, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.errors import ConfigError
from giveway.risk.inputs import RandomInputs, people_placed, read_inputs

MANY = {
    "vehicle.mass": {"normal": [1000, 100]},
    "vehicle.friction": {"lognormal": [100, 0.5]},
    "ego.depart_time": {"uniform": [2, 4]},
    "crowd.desired_speed_mean": {"truncated-normal": [1.4, 0.1, 1.2, 1.6]},
    "regulation.safe_distance": {"triangular": [4, 8, 12]},
    "perception.position_noise": {"exponential": 0.1},
    "crowd.preset": {"choice": ["MIXED", "SIM"]},
}


def test_the_median_vector_makes_the_medians():
    inputs = RandomInputs(read_inputs(MANY, "mine"), people=0)
    values = inputs.values(np.zeros(inputs.dimension))
    numbers = [values[name] for name in list(MANY)[:-1]]
    assert numbers == pytest.approx([1000, 100, 3, 1.4, 8, 0.1 * np.log(2)])
    assert values["crowd.preset"] == "SIM"


def test_the_draw_of_an_injury_is_a_component_that_no_setting_has():
    inputs = RandomInputs(read_inputs(MANY, "mine"), people=2, draws_injury=True)
    without = RandomInputs(inputs.scalars, people=2)
    vector = np.append(np.full(without.dimension, 0.3), 1.0)
    assert inputs.groups == without.groups | {"injury": [inputs.dimension - 1]}
    assert inputs.settings(vector) == without.settings(vector[:-1])
    assert inputs.injury_draw(vector) == pytest.approx(0.8413, abs=1e-4)
    assert np.isnan(without.injury_draw(vector))


def test_many_vectors_have_the_declared_distribution():
    inputs = RandomInputs(read_inputs(MANY, "mine"), people=0)
    vectors = np.random.default_rng(1).standard_normal((1000, inputs.dimension))
    drawn = [inputs.values(vector) for vector in vectors]
    mass = np.array([values["vehicle.mass"] for values in drawn])
    assert (mass.mean(), mass.std()) == pytest.approx((1000, 100), rel=0.05)
    speeds = [values["crowd.desired_speed_mean"] for values in drawn]
    assert min(speeds) >= 1.2
    assert max(speeds) <= 1.6
    assert np.mean([values["crowd.preset"] == "SIM" for values in drawn]) == pytest.approx(
        0.5, abs=0.05
    )


def test_the_first_component_is_the_seed_and_the_last_ones_place_people():
    inputs = RandomInputs(read_inputs({"vehicle.mass": {"normal": [1000, 100]}}, "mine"), people=2)
    vector = np.arange(8.0) / 10.0
    settings = inputs.settings(vector)
    assert inputs.dimension == 8
    assert settings["crowd"]["draws"] == vector[2:].tolist()
    assert 1 <= settings["seed"] < 2**31
    others = inputs.settings(np.array([1e-9, *vector[1:]]))
    assert others["seed"] != inputs.settings(vector + 1.0)["seed"]


@pytest.mark.parametrize("extreme", [-38.0, 38.0])
def test_the_seed_of_an_extreme_vector_is_a_seed(extreme):
    seed = RandomInputs((), people=0).settings(np.array([extreme]))["seed"]
    assert 1 <= seed < 2**31


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"normal": [1000]}, "expected 2 numbers: mean, deviation"),
        ({"normal": [1000, -1]}, "expected deviations above 0"),
        ({"uniform": [4, 2]}, "low < high"),
        ({"normal": [1, "x"]}, "expected 2 numbers"),
        ({"gauss": [1, 2]}, "no distribution is called 'gauss'"),
        ({"choice": ["SIM"]}, "expected two values or more"),
        (5, "expected one distribution and its numbers"),
    ],
)
def test_a_wrong_input_is_one_line_with_its_key(given, said):
    with pytest.raises(ConfigError, match=said) as caught:
        read_inputs({"vehicle.mass": given}, "mine.toml")
    assert str(caught.value).startswith("mine.toml: [inputs] vehicle.mass")


def test_people_have_components_where_their_number_is_fixed():
    plaza = RunConfig(crowd={"pedestrians": 4})
    meeting = RunConfig(crowd={"pedestrians": 4, "sampler": "encounters"})
    assert people_placed(plaza, None, "mine") == 4
    assert people_placed(plaza, False, "mine") == 0
    assert people_placed(meeting, None, "mine") == 0
    with pytest.raises(ConfigError, match="nobody can be placed"):
        people_placed(meeting, True, "mine")


@pytest.mark.parametrize("wanted", [1, 0, "yes", [True], {}])
def test_people_have_components_or_not_and_nothing_else_says_so(wanted):
    with pytest.raises(ConfigError, match=r"crowd = .*: expected true or false"):
        people_placed(RunConfig(), wanted, "mine")


def test_a_number_that_overflows_is_infinite_and_no_error():
    (heavy,) = read_inputs({"vehicle.mass": {"lognormal": [1000, 500]}}, "mine.toml")
    with np.errstate(over="ignore"):
        assert heavy.value(3.0) == np.inf
