"""The benchmark's study: frozen scenes, people and seeds, and the settings a controller needs."""

import hashlib
from importlib.resources import files

import pytest

from giveway.errors import ConfigError
from giveway.studies.benchmark import VERSION, benchmark_of, scenes
from giveway.studies.plan import plan

FROZEN = {1: "a3c469f1689d4556"}
"""The first 16 digits of the SHA-256 of scenes.toml, by version."""


def test_another_set_of_scenes_has_another_version():
    content = (files("giveway.studies.benchmark") / "scenes.toml").read_bytes()
    assert hashlib.sha256(content).hexdigest()[:16] == FROZEN[VERSION]


def test_each_controller_meets_the_same_people_in_each_scene():
    planned = plan(benchmark_of(["pid-tuned", "idm", "pid-tuned"]), "benchmark")
    assert len(planned.cells) == len(scenes()) * 2 * 2
    assert planned.seeds == range(701, 801)
    for planned_cell in planned.cells:
        levels, config = planned_cell.cell.levels, planned_cell.config
        assert config.controller == levels["controller"].label
        assert config.crowd.preset == levels["people"].label
        assert config.twin


def test_the_study_is_named_after_its_controllers():
    assert benchmark_of(["pid-tuned", "mine.driver:Driver"]).name == (
        "benchmark_pid-tuned_mine.driver-Driver"
    )
    assert benchmark_of(["a/b/my.fmu"]).name == "benchmark_my.fmu"
    assert len(benchmark_of(["mpc", "x" * 200]).name) <= 80


def test_a_file_has_the_options_of_the_controller(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("[controller_options]\nheadway = 1.5\n", encoding="utf-8")
    definition = benchmark_of(["idm"], file)
    assert definition.run == {"controller_options": {"headway": 1.5}, "twin": True}
    assert plan(definition, "benchmark").cells[0].config.controller_options == {"headway": 1.5}


@pytest.mark.parametrize("text", ["seed = 3", "[crowd]\npedestrians = 1", "twin = false"])
def test_what_the_benchmark_fixes_is_refused(text, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(text + "\n", encoding="utf-8")
    with pytest.raises(
        ConfigError, match=r"mine\.toml: \w+ = .*: the benchmark fixes it; expected"
    ):
        benchmark_of(["idm"], file)
