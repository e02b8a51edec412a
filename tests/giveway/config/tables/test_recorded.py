"""``[[crowd.recorded]]`` as people write it, right and wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml, read_toml, read_toml_text
from giveway.config.files.loading import as_layer, load
from giveway.errors import ConfigError

if TYPE_CHECKING:
    from pathlib import Path

RECORDED = """
[[crowd.recorded]]
path = "DUT"
dataset = "dut"
clip = "roundabout_04"
begin = -2.5
x = 10
heading = 90
[[crowd.recorded]]
name = "yard"
path = "yard"
dataset = "citr"
"""


def of(text: str) -> RunConfig:
    return load([read_toml_text(text, "my.toml")])[0]


def test_an_entry_is_read_as_it_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    first, second = of(RECORDED).crowd.recorded
    assert (first.name, second.name) == ("recorded0", "yard")
    assert first.path == str(tmp_path / "DUT")
    assert (first.begin, first.x, first.y, first.heading) == (-2.5, 10.0, 0.0, 90.0)
    assert of(RECORDED).crowd.adds_people


def test_a_written_configuration_reads_as_the_same() -> None:
    model = "[crowd]\nmodel = 'recorded'\n[model_options]\ntime = 1.0\n"
    config = of(model + RECORDED)
    assert load([read_toml_text(dump_toml(config), "again")])[0] == config
    assert RunConfig.model_validate_json(config.model_dump_json()) == config
    assert load([as_layer(config)])[0] == config


def test_paths_count_from_the_folder_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "clips").mkdir()
    (tmp_path / "own.toml").write_text("")
    text = '[[crowd.recorded]]\npath = "clips"\ndataset = "own.toml"\n'
    (tmp_path / "run.toml").write_text(text)
    (entry,) = load([read_toml(tmp_path / "run.toml")])[0].crowd.recorded
    assert entry.path == str(tmp_path / "clips")
    assert entry.dataset == str(tmp_path / "own.toml")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("recorded = 3", "recorded = 3: expected tables, each headed [[crowd.recorded]]"),
        ("[[crowd.recorded]]\ndataset = 'dut'", "recorded 'recorded0': path is missing"),
        ("[[crowd.recorded]]\npath = 'a'", "recorded 'recorded0': dataset is missing"),
        (
            "[[crowd.recorded]]\npath = 'a'\ndataset = 'dut'\nspeed = 1",
            "recorded 'recorded0': unknown key 'speed'; expected one of name, path, dataset",
        ),
        (
            "[[crowd.recorded]]\npath = 'a'\ndataset = 'dut'\nheading = 400",
            "heading = 400: ",
        ),
        (
            "[[crowd.recorded]]\npath = 'a'\ndataset = 'dut'\nwalk_on = -1",
            "walk_on = -1: ",
        ),
        (
            "[[crowd.recorded]]\npath = 'a'\ndataset = 'dut'\nname = 'a b'",
            "recorded 'a b': name = 'a b': ",
        ),
        ("model = 'recorded'", "model = 'recorded': nobody is recorded"),
    ],
)
def test_a_wrong_entry_is_named_in_one_line(text: str, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        of(f"[crowd]\n{text}\n")
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("then = 'recorded'", "[model_options] then = 'recorded': "),
        ("distance = -1", "[model_options] distance = -1: "),
        ("detour = true", "[model_options] detour: 'recorded' has no such option"),
    ],
)
def test_a_wrong_option_of_the_model_is_named(options: str, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        of(f"[crowd]\nmodel = 'recorded'\n[model_options]\n{options}\n{RECORDED}")
    assert said in str(error.value)


def test_nobody_predicts_by_a_recording() -> None:
    with pytest.raises(ConfigError, match="model = 'recorded': expected 'vci'"):
        of(f"[perception]\nmodel = 'recorded'\n{RECORDED}")
