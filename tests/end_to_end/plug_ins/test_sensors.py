"""Sensors of other packages: as docs/plugins.md prints one, and some that perceive less."""

from __future__ import annotations

import json
import re
import tomllib

import numpy as np
import pytest
from support.plug_ins import printed

import giveway
from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml, read_toml
from giveway.config.files.loading import load
from giveway.ego.perception import SensorSetup
from giveway.ego.perception.conformance import check_sensor
from giveway.errors import ConfigError, ControlError, SensorError

GROUP = "giveway.sensors"
TOYS = """
import os
from dataclasses import dataclass

import numpy as np

from giveway.ego.perception import Percept


@dataclass(frozen=True)
class Options:
    kind: str = "even"


class Toy:
    Options = Options

    def __init__(self, setup, options):
        self.kind, self.asked = options.kind, 0

    def observe(self, truth, person_ids, ego):
        self.asked += 1
        seen = getattr(self, self.kind)(person_ids)
        people, ids = truth.people.select(seen), person_ids[seen]
        if self.asked > 20:
            if self.kind == "raising":
                raise ValueError("no idea")
            if self.kind == "stranger":
                ids[0] = 10**6
            if self.kind == "twice":
                ids[0] = ids[1]
            if self.kind == "nan":
                people.position[0, 0] = np.nan
            if self.kind == "bare":
                return people
            if self.kind == "ending":
                os._exit(0)
        if self.kind == "flickering":
            return Percept(people, ids, np.zeros(len(ids)), np.full(len(ids), 0.1))
        return Percept(people, ids)

    def even(self, ids):
        return ids % 2 == 0

    def nobody(self, ids):
        return ids < 0

    def flickering(self, ids):
        return (ids + self.asked // 3) % 4 != 0

    def everybody(self, ids):
        return ids >= 0

    raising = stranger = twice = nan = bare = ending = everybody
"""


@pytest.fixture
def toys(installed):
    return installed("toy_sensors", TOYS, declares="toy = toy_sensors:Toy", group=GROUP)


@pytest.fixture
def limited_range(installed):
    """The package of the page."""
    points = tomllib.loads(printed("file: sensor pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points[GROUP].items()
    text = printed("file: limited_range.py")
    return installed("limited_range", text, declares=f"{name} = {value}", group=GROUP)


def drive(kind: str, results=None, **settings):
    """A run whose ego has a toy sensor; double underscores in keys are dots."""
    run = {"perception.sensor": "toy", "sensor_options.kind": kind, "seed": 2}
    run |= {key.replace("__", "."): value for key, value in settings.items()}
    return giveway.run(run, results=results, pictures=False)


def predicted(result) -> set[int]:
    """The ids of all persons whom ``predictions.csv`` names."""
    ids = result.crowd_track.ids
    return {ids.index(name) for name in result.predictions["id"]}


@pytest.mark.parametrize(
    "scenario", ["crossings", "encounter", "junction", "shared_space", "street"]
)
def test_every_second_person_is_perceived(toys, scenario):
    settings = {"scenario": scenario, "time_limit": 12.0, "record__predictions": 0.5}
    result = drive("even", **settings, crowd__pedestrians=16)
    assert len(result.egos[0].track.time) >= 200
    whom = predicted(result)
    assert whom
    assert all(person % 2 == 0 for person in whom)
    assert {*result.crowd_track.pedestrian} > whom  # the tables keep those who are not perceived


@pytest.mark.parametrize("controller", ["mpc", "pid-tuned", "mpc-paper"])
def test_an_ego_whose_sensor_sees_nobody_drives_as_if_alone(toys, controller):
    """Nothing but the sensor is shown the truth."""
    settings = {"controller": controller, "seed": 13, "time_limit": 12.0}
    blind = drive("nobody", crowd__pedestrians=40, **settings).egos[0].track
    alone = giveway.run(settings | {"crowd.pedestrians": 0}, pictures=False).egos[0].track
    assert np.array_equal(blind.force, alone.force)
    assert np.isinf(alone.gap).all()


def test_the_tables_keep_the_gap_to_people_who_are_not_perceived(toys):
    result = drive("nobody", scenario="encounter", time_limit=12.0)
    assert np.isfinite(result.egos[0].track.gap).any()


def test_a_sensor_that_sees_everybody_changes_no_number(toys):
    settings = {"crowd.pedestrians": 20, "seed": 2, "time_limit": 8.0}
    own = giveway.run(settings, pictures=False)
    hosted = drive("everybody", crowd__pedestrians=20, time_limit=8.0)
    assert np.array_equal(own.egos[0].track.force, hosted.egos[0].track.force)


@pytest.mark.parametrize("noise", [0.0, 0.1])
@pytest.mark.parametrize("scenario", ["junction", "shared_space"])
def test_people_may_vanish_and_come_back(toys, scenario, noise):
    result = drive(
        "flickering",
        scenario=scenario,
        crowd__pedestrians=16,
        time_limit=12.0,
        perception__position_noise=noise,
        perception__desired_speeds="typical",
        perception__goals="heading",
        record__predictions=0.5,
    )
    track = result.egos[0].track
    assert len(track.time) >= 200
    assert np.isfinite(track.force).all()
    assert predicted(result)


def test_two_egos_have_a_sensor_each(toys):
    egos = [
        {"ego": {"id": "seeing"}, "perception": {"sensor": "all"}},
        {"ego": {"id": "blind", "depart_time": 6.0}},
    ]
    settings = {"time_limit": 12.0, "record__predictions": 0.5}
    result = drive("nobody", **settings, crowd__pedestrians=30, egos=egos)
    assert len(result.egos) == 2
    assert set(result.predictions["ego"]) == {"seeing"}


FAULTS = {
    "raising": r"raised ValueError: no idea \(toy_sensors.py:\d+\)",
    "stranger": r"returned person_ids with 1000000: expected those of people whom it was shown",
    "twice": r"returned person_ids array\(.*: expected each person once",
    "nan": r"returned position nan: expected finite numbers",
    "bare": r"returned Crowd\(.*: expected a Percept of a Crowd",
}


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_ends_the_run_with_one_line(toys, kind):
    with pytest.raises(SensorError) as caught:
        drive(kind, crowd__pedestrians=5, controller="pid-tuned", time_limit=2.0)
    assert re.match(rf"sensor at step 20: 'toy' of 'ego' {FAULTS[kind]}", str(caught.value))
    assert str(caught.value).isprintable()
    assert len(caught.value.result.egos[0].track.time) >= 20


def test_a_sensor_that_ends_the_process_is_named(toys, study_of, tmp_path):
    text = """
name = "ends"
replications = 1
[run]
controller = "pid-tuned"
time_limit = 2.0
crowd = { pedestrians = 3 }
perception = { sensor = "toy" }
[factors]
"sensor_options.kind" = ["even", "ending"]
"""
    study = study_of(text, tmp_path / "study", jobs=1, hang_limit=10.0)
    ((run, cause),) = study.failures[["run", "cause"]].to_numpy()
    assert run == "c2-s1"
    assert re.search(r"in the sensor 'toy' at .*step 20", cause)


def test_the_printed_sensor_drives_as_the_printed_settings_say(limited_range, tmp_path):
    settings = tomllib.loads(printed("sensor run")) | {"seed": 3, "time_limit": 10.0}
    settings["crowd"] = {"pedestrians": 20}
    result = giveway.run(settings, results=tmp_path / "run", pictures=False)
    told = json.loads((tmp_path / "run" / "manifest.json").read_text(encoding="utf-8"))
    told = told["sensors"]["ego"]
    assert told["distribution"] == "limited-range"
    assert told["options"] == {"range": 15.0, "missed": 0.0}
    config, _ = load([read_toml(tmp_path / "run" / "config.toml")])
    assert config.sensor_options == {"range": 15.0}
    near = giveway.run(settings | {"sensor_options": {"range": 3.0}}, pictures=False)
    assert not np.array_equal(near.egos[0].track.force, result.egos[0].track.force)


def test_a_results_folder_alone_imports_no_class(limited_range, tmp_path):
    name = "limited_range:LimitedRange"
    settings = {"perception.sensor": name, "time_limit": 0.2}
    giveway.run(settings, results=tmp_path / "run", pictures=False)
    with pytest.raises(ConfigError, match=f"--perception-sensor {name}"):
        load([read_toml(tmp_path / "run" / "config.toml")])
    assert load([read_toml(tmp_path / "run" / "config.toml")], trusted={name})


def test_options_are_those_of_the_sensor_that_is_named_last(limited_range, type_here, tmp_path):
    config = RunConfig(perception={"sensor": "limited-range"}, sensor_options={"range": 9.0})
    assert RunConfig.model_validate(tomllib.loads(dump_toml(config))) == config
    words = ["--perception-sensor", "limited-range"]
    typed = type_here("config", *words, "--set-sensor", "range=9")
    assert tomllib.loads(typed.stdout)["sensor_options"] == {"range": 9}
    file = tmp_path / "near.toml"
    file.write_text(printed("sensor run"), encoding="utf-8")
    typed = type_here("config", "--config", file, "--perception-sensor", "all")
    assert "sensor_options" not in tomllib.loads(typed.stdout)
    refused = type_here("run", *words, "--set-sensor", "rang=9", "-q")
    assert refused.returncode == 2
    assert "[sensor_options] rang: 'limited-range' has no such option" in refused.stderr
    with pytest.raises(ConfigError, match="range: 'all' has no options there"):
        giveway.run({"sensor_options.range": 1.0})


def test_check_tells_in_words_whether_it_keeps_to_the_rules(limited_range, toys, type_here):
    typed = type_here("check", "sensor", "limited-range", "--set", "missed=0.3")
    assert typed.returncode == 0, typed.stdout
    assert "limited-range: sound" in typed.stdout
    typed = type_here("check", "sensor", "toy", "--set", "kind=nan")
    assert typed.returncode == 1
    assert "broken  answers with a percept" in typed.stdout
    assert type_here("check", "sensor", "all").returncode == 2
    from limited_range import LimitedRange, RangeOptions

    setup = SensorSetup(0.05, 1, "ego")
    findings = check_sensor(lambda given: LimitedRange(given, RangeOptions()), setup)
    assert not [finding for finding in findings if finding.problem]


def test_a_class_without_observe_and_one_that_is_not_there(installed):
    installed("idle_sensor", "class Idle:\n    def __init__(self, setup):\n        pass\n")
    for name, error in (
        ("idle_sensor:Idle", "expected an object with a method observe"),
        ("idle_sensor:Nobody", "cannot be imported"),
        ("nobody_has.it:This", "no installed package has the module"),
    ):
        with pytest.raises((ControlError, SensorError), match=error):
            giveway.run({"perception.sensor": name, "time_limit": 0.2})
