"""Preset files: written, read back, refused clearly, used in runs and counted in their keys."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import giveway
from giveway.config import RunConfig
from giveway.config.files.loading import as_layer, load
from giveway.config.files.presets import (
    bodies_of,
    crowd_of,
    expected_of,
    parameters_of,
    preset_text,
)
from giveway.config.option import PRESET_NAMES
from giveway.errors import ConfigError
from giveway.studies.identity import cell_digest, input_hashes
from pedestrian_model import PRESETS, SIM, TABLE2, VciParameters

MIXED = PRESETS["MIXED"]


@pytest.fixture
def preset(tmp_path: Path):
    def write(parameters: VciParameters, name: str = "mine.toml") -> str:
        file = tmp_path / name
        file.write_text(preset_text("mine", parameters, {"fitted": ["mass"], "clips": 3}))
        return str(file)

    return write


def test_a_preset_file_comes_back_to_the_last_digit(preset) -> None:
    odd = replace(SIM, vehicle_strength=777.5852 / 3.0, mass=81.0)
    assert parameters_of(preset(odd)) == odd


def test_the_configuration_knows_all_names() -> None:
    assert tuple(PRESETS) == PRESET_NAMES


@pytest.mark.parametrize("name", PRESETS)
def test_the_presets_that_are_built_in_have_their_names(name: str) -> None:
    assert parameters_of(name) == PRESETS[name]


def test_a_changed_file_is_read_again(preset) -> None:
    assert parameters_of(preset(SIM)) == SIM
    assert parameters_of(preset(replace(SIM, mass=90.25))).mass == 90.25


def test_a_base_gives_what_is_not_named(tmp_path: Path) -> None:
    file = tmp_path / "few.toml"
    file.write_text('base = "TABLE2"\n[parameters]\nmass = 70\n')
    assert parameters_of(str(file)) == replace(TABLE2, mass=70)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[parameters\n", "not valid TOML"),
        ("[parameters]\nmass = 80.0\n", "body_radius is missing; give all"),
        ('base = "SIM"\n[parameters]\nmas = 80.0\n', "mas: unknown parameter; did you mean 'mass'"),
        ('base = "SIM"\n[parameters]\nmass = "heavy"\n', "mass = 'heavy', expected a number"),
        ('base = "SIM"\n[parameters]\nmass = -1\n', "mass = -1, expected a number > 0"),
        ('base = "SIMM"\n', "base = 'SIMM': expected one of SIM, TABLE2"),
        ('base = "SIM"\nparameters = 3\n', "expected a table"),
        ('base = "SIM"\n[paramters]\n', "unknown key 'paramters'"),
    ],
)
def test_a_file_that_cannot_be_used_is_named_with_the_key(tmp_path, text, said) -> None:
    file = tmp_path / "broken.toml"
    file.write_text(text)
    with pytest.raises(ConfigError) as error:
        parameters_of(str(file))
    assert str(file) in str(error.value)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"crowd": {"preset": "SIMM"}}, "expected SIM, TABLE2, MIXED, CITR, DUT or a preset file"),
        ({"crowd": {"preset": "no.toml"}}, r"\[crowd\] preset: no.toml: no preset file"),
        ({"perception": {"preset": "no.toml"}}, r"\[perception\] preset: no.toml"),
        ({"crowd": {"preset": ""}}, "at least 1"),
    ],
)
def test_a_run_refuses_a_preset_that_is_not_there(settings, said) -> None:
    with pytest.raises(ConfigError, match=said):
        load([as_layer(settings)])


def test_a_file_beside_the_configuration_is_found_from_anywhere(preset, tmp_path) -> None:
    preset(SIM)
    config = tmp_path / "run.toml"
    config.write_text('[crowd]\npreset = "mine.toml"\n[perception]\npreset = "mine.toml"\n')
    loaded = load([as_layer(config)])[0]
    assert loaded.crowd.preset == loaded.perception.preset == str(tmp_path / "mine.toml")


PEOPLE = {"pedestrians": 30}


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ({}, MIXED),
        ({"crowd": {"preset": "SIM"}}, MIXED),
        ({"crowd": {"preset": "SIM"}, "perception": {"preset": "TABLE2"}}, TABLE2),
        ({"controller": "mpc-paper"}, SIM),
        ({"controller": "mpc-paper", "crowd": {"preset": "TABLE2"}}, TABLE2),
        ({"controller": "mpc-paper", "perception": {"preset": "MIXED"}}, MIXED),
    ],
)
def test_only_the_papers_controllers_predict_by_the_crowds(said, expected) -> None:
    (ego,) = load([as_layer({"scenario": "shared_space"} | said)])[0].each_ego()
    assert expected_of(ego) == expected


def test_another_model_is_believed_with_its_own_acceleration() -> None:
    believed = {"crowd": {"preset": "SIM"}, "perception": {"model": "orca"}}
    (ego,) = load([as_layer({"scenario": "shared_space"} | believed)])[0].each_ego()
    assert expected_of(ego) == replace(MIXED, max_acceleration=SIM.max_acceleration)


SETTINGS = {"controller": "mpc-paper", "seed": 3, "time_limit": 8.0}


def test_a_run_walks_with_one_preset_and_predicts_with_another(preset) -> None:
    """The crowd's own decides how people walk; the other, what the controller expects."""
    strange = replace(SIM, vehicle_strength=0.0, repulsion_strength=30.0)
    copy, other = preset(SIM, "copy.toml"), preset(strange, "strange.toml")

    def drive(crowd: str, expected: str):
        return giveway.run(
            SETTINGS
            | {
                "crowd": PEOPLE | {"preset": crowd},
                "perception": {"preset": expected},
                "record": {"predictions": 0.75},
            }
        )

    plain, copied, mistaken = drive("SIM", ""), drive(copy, ""), drive("SIM", other)
    assert copied.trajectories.equals(plain.trajectories), "the same numbers from a file"
    assert copied.predictions.equals(plain.predictions)
    assert len(mistaken.predictions)
    assert not mistaken.predictions.equals(plain.predictions)
    assert not drive(other, "").trajectories.equals(plain.trajectories)


def test_a_studys_key_knows_the_files_content_not_its_place(preset, tmp_path) -> None:
    def key(file: str, table: str = "crowd") -> str:
        config, scenario = load([as_layer({table: {"preset": file}})])
        return cell_digest(config, input_hashes(config, scenario), "software")

    (tmp_path / "elsewhere").mkdir()
    here, there = preset(SIM), preset(SIM, "elsewhere/mine.toml")
    for table in ("crowd", "perception"):
        before = key(here, table)
        assert key(there, table) == before
        Path(there).write_text(preset_text("mine", TABLE2, {}))
        assert key(there, table) != before
        preset(SIM, "elsewhere/mine.toml")


@pytest.mark.parametrize("table", ["crowd", "perception"])
def test_a_run_refuses_a_preset_by_which_people_tremble(preset, table) -> None:
    file = preset(replace(SIM, destination_gain=5453.0), "shaky.toml")
    with pytest.raises(ConfigError, match=rf"\[{table}\] preset .*shaky.toml: .* = 3.4 > 1"):
        giveway.run({table: {"preset": file}})


@pytest.mark.parametrize("name", PRESET_NAMES)
def test_only_vci_has_the_presets_largest_acceleration(name: str) -> None:
    assert bodies_of("vci", name) == PRESETS[name]
    for model in ("social-force", "orca", "jupedsim:SocialForceModel", "mine:People"):
        expected = replace(PRESETS[name], max_acceleration=SIM.max_acceleration)
        assert bodies_of(model, name) == expected


def test_recorded_people_have_the_limits_of_their_next_model() -> None:
    recorded = {"model": "recorded", "recorded": [{"name": "a", "path": "a", "dataset": "dut"}]}

    def limit(**options) -> float:
        config = RunConfig.model_validate({"crowd": recorded, "model_options": options})
        return crowd_of(config).max_acceleration

    assert limit() == PRESETS["MIXED"].max_acceleration
    assert limit(then="orca") == SIM.max_acceleration
