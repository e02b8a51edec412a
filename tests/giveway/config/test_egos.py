"""Several egos: their entries, what they take from the run, and what contradicts."""

import tomllib

import pytest
from pydantic import ValidationError

from giveway.config import RunConfig
from giveway.config.files.layers import Layer, build_config, dump_toml
from giveway.errors import ConfigError


def test_an_ego_entry_overrides_its_own_keys_only() -> None:
    config = RunConfig.model_validate(
        {
            "controller": "pid",
            "vehicle": {"mass": 1200.0},
            "egos": [
                {"ego": {"id": "a", "route": ["x"]}, "controller": "mpc"},
                {"ego": {"take_over": "b"}, "vehicle": {"friction": 50.0}},
            ],
        }
    )
    first, second = config.each_ego()
    assert (first.ego_id, first.controller, first.vehicle.mass) == ("a", "mpc", 1200.0)
    assert (second.ego_id, second.controller, second.vehicle.friction) == ("b", "pid-paper", 50.0)
    assert second.vehicle.mass == 1200.0
    again = build_config([Layer("dump", tomllib.loads(dump_toml(config)))])
    assert again.each_ego() == config.each_ego()


def test_several_vehicles_of_the_scenario_become_several_egos() -> None:
    config = RunConfig.model_validate({"ego": {"take_over": "b.1, c"}})
    assert [one.ego_id for one in config.each_ego()] == ["b.1", "c"]
    assert RunConfig.model_validate({"ego": {"none": True}}).each_ego() == ()


@pytest.mark.parametrize(
    ("entry", "expected"),
    [
        ({"crowd": {"pedestrians": 3}}, r"egos\[0\]: unknown key 'crowd'"),
        ({"vehicle": {"mass": -1}}, r"egos\[0\]: vehicle.mass = -1"),
        ({"vehicle": {"mass": 1e-9}}, r"vehicle.mass = 1e-09: should be at least 10 \[kg\]: the"),
        ({"ego": {"initial_speed": 30}}, r"expected at most \[vehicle\] speed_max"),
    ],
)
def test_a_wrong_ego_entry_is_named(entry: dict, expected: str) -> None:
    with pytest.raises(ConfigError, match=expected):
        build_config([Layer("study.toml", {"egos": [entry]})])


def test_unfit_settings_of_one_ego_are_told_in_one_line():
    entry = {"ego": {"id": "b"}, "perception": {"model": "shy_people:Shy"}}
    with pytest.raises(ValidationError) as caught:
        RunConfig.model_validate({"egos": [entry]})
    said = caught.value.errors()[0]["msg"]
    assert "egos[0]: [perception] model = 'shy_people:Shy': the people walk by 'vci'" in said
    assert len(said) < 300
