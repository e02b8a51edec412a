"""What a profile wants to have recorded stands in ego.csv, wherever the FMU runs."""

from __future__ import annotations

import json
import re

import numpy as np
import pandas as pd
import pytest
import tomlkit

import giveway as library
from fmus import FmuProfileError, FmuVariableError, VehicleFmu, make_profile
from giveway.errors import VehicleError
from giveway.replays.run_folder import RunFolder

RECORDED = ("wheel_force", "gear", "clock")
SHORT = {"controller": "pid-tuned", "crowd": {"pedestrians": 0}, "time_limit": 2.0}


@pytest.fixture
def drive(zoo, tmp_path):
    def run(record=RECORDED, isolation="process", folder="run", **car):
        car = {"outputs": ("speed", "position", *RECORDED)} | car
        fmu = zoo.car(**car)
        profile = tmp_path / f"{folder}.toml"
        values = {"record": list(record)} | zoo.profile(fmu)
        profile.write_text(tomlkit.dumps(values), encoding="utf-8")
        vehicle = {"fmu": str(fmu), "profile": str(profile), "isolation": isolation}
        out = tmp_path / folder
        return library.run(SHORT | {"vehicle": vehicle}, results=out, pictures=False), out

    return run


@pytest.mark.parametrize(
    "car",
    [{}, {"fmi": "3.0"}, {"fmi": "3.0", "float32": True}, {"kind": "model-exchange"}],
    ids=["fmi2", "fmi3", "float32", "model exchange"],
)
def test_recorded_variables_stand_in_the_egos_table(drive, car):
    result, out = drive(**car)
    table = pd.read_csv(out / "ego.csv")
    assert tuple(table.columns[-3:]) == RECORDED
    since = table["time"] - table["time"].iloc[0]
    assert table["clock"].to_numpy() == pytest.approx(since.to_numpy(), abs=1e-5)
    applied = table["force"].shift(1).iloc[1:]
    assert table["wheel_force"].iloc[1:].to_numpy() == pytest.approx(applied, rel=1e-5, abs=1e-3)
    package = json.loads((out / "datapackage.json").read_text(encoding="utf-8"))
    (ego,) = [part for part in package["resources"] if part["name"] == "ego"]
    fields = {field["name"]: field for field in ego["schema"]["fields"]}
    assert fields["wheel_force"]["unit"] == "N"
    assert fields["clock"]["unit"] == "s"
    assert RunFolder.read(out).ego["clock"].iloc[-1] == pytest.approx(since.iloc[-1], abs=1e-5)
    assert [output.name for output in result.egos[0].outputs] == list(RECORDED)


def test_a_process_of_its_own_changes_no_value(drive):
    alone, _ = drive(isolation="process", folder="alone")
    here, _ = drive(isolation="none", folder="here")
    for one, other in zip(alone.egos[0].outputs, here.egos[0].outputs, strict=True):
        assert one[:3] == other[:3]
        assert np.array_equal(one.values, other.values)


def test_without_a_record_the_columns_are_the_usual_ones(drive):
    _, out = drive(record=())
    table = pd.read_csv(out / "ego.csv")
    assert list(table.columns)[-1] == "waits_for"


def test_of_two_egos_each_has_its_own(zoo, tmp_path):
    fmu = zoo.car(outputs=("speed", "position", "clock"))
    profile = tmp_path / "car.toml"
    text = tomlkit.dumps({"record": ["clock"]} | zoo.profile(fmu))
    profile.write_text(text, encoding="utf-8")
    egos = [
        {"ego": {"id": "a"}, "vehicle": {"fmu": str(fmu), "profile": str(profile)}},
        {"ego": {"id": "b", "depart_time": 2.0}},
    ]
    table = library.run(SHORT | {"time_limit": 4.0, "egos": egos}).ego
    assert table[table["id"] == "a"]["clock"].notna().all()
    assert table[table["id"] == "b"]["clock"].isna().all()


def test_a_recorded_name_that_a_column_has_already_is_refused(drive):
    names = {"wheel_force": "gap"}
    with pytest.raises(VehicleError, match=r"run\.toml: record: 'gap' is a column of ego\.csv"):
        drive(record=["gap"], names=names)


@pytest.mark.parametrize(
    ("record", "said"),
    [
        (
            ["wheel_forc"],
            r"record: no variable 'wheel_forc' in the FMU; did you mean",
        ),
        (["force"], r"record: variable 'force' is input Real; expected a number that the FMU"),
        (["mass"], r"record: variable 'mass' is parameter Real"),
    ],
)
def test_what_cannot_be_recorded_is_one_line(zoo, record, said):
    fmu = zoo.car(outputs=("speed", "position", *RECORDED))
    profile = make_profile({"record": record} | zoo.profile(fmu), "car.toml")
    with pytest.raises(FmuVariableError, match=said) as caught:
        VehicleFmu(fmu, step_size=0.05, profile=profile)
    assert re.search(r"\n", str(caught.value)) is None


def test_each_stands_once(zoo):
    values = {"record": ["clock", "clock"]} | zoo.profile(zoo.car())
    with pytest.raises(FmuProfileError, match="'clock' is given twice"):
        make_profile(values, "car.toml")
