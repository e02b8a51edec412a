"""The names of runs: titles and folders tell what differs."""

from __future__ import annotations

import pytest

from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.config.files.naming import default_folder, title


def named(**settings):
    """Return title and folder of a run on the shared space with ten people."""
    crowd = {"pedestrians": 10, **settings.pop("crowd", {})}
    config, found = load([Layer("", {"scenario": "shared_space", "crowd": crowd, **settings})])
    people = f"{config.crowd.pedestrians} pedestrians"
    return title(config, found.name, people), default_folder(config, found.name).name


def test_a_plain_run_is_named_by_scenario_controller_people_and_seed():
    assert named(seed=3) == (
        "shared_space: MPC, 10 pedestrians, seed 3",
        "shared_space_mpc_10ped_seed3",
    )


@pytest.mark.parametrize(
    ("settings", "words", "part"),
    [
        ({"controller_options": {"style": "assertive"}}, "assertive", "assertive"),
        ({"controller_options": {"horizon": 4}}, "horizon 4", "horizon-4"),
        ({"crowd": {"model": "social-force"}}, "social-force", "social-force"),
        ({"vehicle": {"fmu": "fmi3"}}, "fmi3", "fmi3"),
        ({"safety": {"enabled": False}}, "no safety", "no-safety"),
        ({"crowd": {"two_sided": True}}, "two sided", "two-sided"),
        ({"ego": {"initial_speed": 2.5}}, "initial speed 2.5 m/s", "initial-speed-2.5"),
        ({"twin": True}, "twin", "twin"),
    ],
)
def test_a_setting_that_differs_is_in_title_and_folder(settings, words, part):
    assert named(**settings) == (
        f"shared_space: MPC, {words}, 10 pedestrians, seed 1",
        f"shared_space_mpc_{part}_10ped_seed1",
    )


def test_an_fmu_is_told_by_its_name_and_not_by_what_was_found_of_it():
    told, folder = named(vehicle={"fmu": "fmi3", "mass": 1402.69, "friction": 15.0, "width": 1.8})
    assert told == "shared_space: MPC, fmi3, 10 pedestrians, seed 1"
    assert folder.rpartition("_")[0] == "shared_space_mpc_fmi3_10ped_seed1"
    assert named(vehicle={"mass": 1500.0})[0].startswith("shared_space: MPC, mass 1500 kg, ")


def test_more_than_three_differences_are_counted_and_hashed():
    many = {
        "controller_options": {"style": "careful"},
        "ego": {"initial_speed": 2.0},
        "twin": True,
        "time_limit": 20.0,
    }
    told, folder = named(**many)
    assert told.startswith("shared_space: MPC, careful, time limit 20 s, twin, 1 more, 10 ped")
    assert folder.rpartition("_")[0].endswith("_1-more_10ped_seed1")
    assert folder != named(**many | {"ego": {"initial_speed": 2.1}})[1]


def test_a_long_value_is_called_own_and_hashed():
    told, folder = named(crowd={"zone": "0,0 100,0 100,100 0,100 0,50"}, twin=True)
    assert told == "shared_space: MPC, twin, own zone, 10 pedestrians, seed 1"
    start, _, digits = folder.rpartition("_")
    assert start == "shared_space_mpc_twin_own-zone_10ped_seed1"
    assert len(digits) == 6


def test_what_is_recorded_is_no_part_of_the_title_but_tells_folders_apart():
    told, folder = named(record={"near": 20.0})
    assert told == named()[0]
    assert folder != named()[1]
    assert folder != named(record={"near": 30.0})[1]


def test_an_ego_less_run_and_words_for_its_drivers():
    assert named(ego={"none": True})[0] == "shared_space: no ego, 10 pedestrians, seed 1"
    config, _ = load([Layer("", {"scenario": "shared_space"})])
    assert title(config, "plaza", ego="2 egos") == "plaza: 2 egos, seed 1"
