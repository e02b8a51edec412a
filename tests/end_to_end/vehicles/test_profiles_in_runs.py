"""What a profile changes in a run: the controller's model, its margin, and whose it is."""

from __future__ import annotations

from pathlib import Path

import pytest
import tomlkit

import giveway as library
from giveway.config.files.layers import Layer, read_toml
from giveway.config.files.loading import load
from giveway.ego.controllers import make_controller
from giveway.ego.vehicle_model import model_margin
from giveway.errors import ConfigError, VehicleError

H = 0.05  # [s]
IDENTIFIED = {
    "mass": 1500.0,
    "friction": 60.0,
    "r_squared": 0.99,
    "speed_error": 0.01,
    "position_error": 0.7,
    "horizon": 1.0,
    "time_step": H,
}


@pytest.fixture
def profile(tmp_path, zoo):
    """Write the profile of a car, with a fitted model or without."""

    def write(name="car.toml", car=None, **model):
        values = zoo.profile(car or zoo.car())
        if model:
            values["model"] = model
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(tomlkit.dumps(values), encoding="utf-8")
        return path

    return write


def file(path, **vehicle):
    """A configuration file, and the layer that it is."""
    path.parent.mkdir(exist_ok=True)
    path.write_text(tomlkit.dumps({"vehicle": vehicle}), encoding="utf-8")
    return read_toml(path)


def flags(**vehicle):
    return Layer("command line", {"vehicle": vehicle}, from_flags=True)


def model(config):
    return config.vehicle.mass, config.vehicle.friction


# ---- which M and alpha win ----


def test_without_a_profile_they_are_the_papers(zoo):
    config, _ = load([flags(fmu=str(zoo.car()))])
    assert model(config) == (1000.0, 100.0)


def test_a_profile_without_a_model_changes_nothing(profile):
    config, _ = load([flags(profile=str(profile()))])
    assert model(config) == (1000.0, 100.0)


def test_the_identified_model_is_the_controllers(profile):
    config, _ = load([flags(profile=str(profile(**IDENTIFIED)))])
    assert model(config) == (1500.0, 60.0)


def test_the_users_file_and_the_flags_win_over_it(profile, tmp_path):
    path = str(profile(**IDENTIFIED))
    own = file(tmp_path / "run.toml", profile=path, mass=1200.0)
    assert model(load([own])[0]) == (1200.0, 60.0)
    assert model(load([own, flags(mass=1100.0)])[0]) == (1100.0, 60.0)
    assert model(load([own, flags(friction=0.0)])[0]) == (1200.0, 0.0)


def test_a_profile_in_the_flags_replaces_the_files(profile, tmp_path):
    own = file(tmp_path / "run.toml", profile=str(profile(**IDENTIFIED)))
    other = profile("other.toml", **IDENTIFIED | {"mass": 1700.0})
    assert model(load([own, flags(profile=str(other))])[0]) == (1700.0, 60.0)


def test_the_scenarios_settings_win_over_it(profile, tmp_path):
    """Profile < scenario < file < flags."""
    folder = tmp_path / "crossing"
    folder.mkdir()
    settings = {"vehicle": {"mass": 1300.0, "profile": str(profile(**IDENTIFIED))}}
    for source in Path(load([])[1].folder).iterdir():
        if source.is_file() and source.suffix != ".toml":
            (folder / source.name).write_bytes(source.read_bytes())
    (folder / "shared_space.giveway.toml").write_text(tomlkit.dumps(settings), encoding="utf-8")
    scenario = Layer("command line", {"scenario": str(folder)}, from_flags=True)
    config, found = load([scenario])
    assert found.settings_file is not None
    assert model(config) == (1300.0, 60.0)
    assert model(load([scenario, flags(mass=900.0)])[0]) == (900.0, 60.0)


def test_a_profile_that_cannot_be_read_is_said(tmp_path):
    with pytest.raises(VehicleError, match=r"none\.toml: no such file"):
        load([flags(profile=str(tmp_path / "none.toml"))])
    (tmp_path / "bad.toml").write_text("[inputs]\n", encoding="utf-8")
    with pytest.raises(VehicleError, match=r"bad\.toml: \[inputs\]"):
        load([flags(profile=str(tmp_path / "bad.toml"))])


# ---- several egos ----


def egos(*vehicles, **base):
    entries = [{"ego": {"id": f"e{n}"}, "vehicle": v} for n, v in enumerate(vehicles)]
    return load([Layer("test", {"vehicle": base, "egos": entries})])[0].each_ego()


def test_each_ego_has_the_model_of_its_own_profile(profile):
    one = str(profile("one.toml", **IDENTIFIED))
    two = str(profile("two.toml", **IDENTIFIED | {"mass": 1700.0, "position_error": 0.1}))
    first, second, third = egos({"profile": two}, {"width": 1.8}, {"profile": two, "mass": 5e3},
                                profile=one)  # fmt: skip
    assert [model(ego) for ego in (first, second, third)] == [
        (1700.0, 60.0),
        (1500.0, 60.0),  # the run's own vehicle
        (5000.0, 60.0),
    ]
    assert [model_margin(ego, H) for ego in (first, second)] == pytest.approx([0.1, 0.7])


def test_what_is_identified_of_one_fmu_is_not_said_of_another(profile, zoo):
    other = {"fmu": str(zoo.car(fmi="3.0"))}
    plain = {"profile": str(profile("plain.toml"))}
    for ego in egos(other, plain, profile=str(profile(**IDENTIFIED))):
        assert model(ego) == (1000.0, 100.0)
        assert model_margin(ego, H) == 0.0
    for ego in egos(other, plain, profile=str(profile(**IDENTIFIED)), mass=800.0):
        assert model(ego) == (800.0, 100.0)  # what the user says holds for all


def test_an_ego_with_another_fmu_has_not_the_runs_profile(profile, zoo):
    (ego,) = egos({"fmu": str(zoo.car(fmi="3.0"))}, profile=str(profile()))
    assert ego.vehicle.profile == ""


# ---- paths ----


def test_files_are_relative_to_the_toml_file(profile, zoo, tmp_path, monkeypatch):
    car = tmp_path / "sub" / "car.fmu"
    written = profile("sub/car.toml", **IDENTIFIED)
    car.write_bytes(zoo.car().read_bytes())
    entry = {"vehicle": {"fmu": "car.fmu", "profile": "car.toml"}}
    run = tmp_path / "sub" / "run.toml"
    run.write_text(tomlkit.dumps(entry | {"egos": [entry]}), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    config, _ = load([read_toml(Path("sub/run.toml"))])
    for vehicle in (config.vehicle, config.each_ego()[0].vehicle):
        assert (vehicle.fmu, vehicle.profile) == (str(car), str(written))
        assert vehicle.mass == 1500.0


def test_files_named_in_flags_or_python_are_relative_to_here(profile, zoo, tmp_path, monkeypatch):
    """The configuration that is recorded means the same in any folder."""
    profile()
    (tmp_path / "car.fmu").write_bytes(zoo.car().read_bytes())
    monkeypatch.chdir(tmp_path)
    entry = {"fmu": "car.fmu", "profile": "car.toml"}
    config, _ = load([Layer("test", {"vehicle": entry, "egos": [{"vehicle": entry}]})])
    for vehicle in (config.vehicle, config.each_ego()[0].vehicle):
        assert Path(vehicle.fmu).is_absolute()
        assert Path(vehicle.profile).is_absolute()


# ---- the margin ----


def test_the_mpc_keeps_what_the_model_is_wrong_by(profile):
    config, _ = load([flags(profile=str(profile(**IDENTIFIED)))])
    plain, _ = load([flags(profile=str(profile("plain.toml")))])
    config, plain = (
        c.model_copy(update={"controller": "mpc-paper"}).each_ego()[0] for c in (config, plain)
    )
    kept, usual = (make_controller(c, H).mpc.parameters.safe_distance for c in (config, plain))
    margin = model_margin(config, H)
    assert margin >= 0.7
    assert kept == pytest.approx(usual + margin)


def test_the_margin_grows_with_a_longer_horizon(profile):
    """As the way under an unknown acceleration: with the square of the time."""
    path = str(profile(**IDENTIFIED))
    margins = []
    for horizon in (10, 20, 40):
        own = {"controller": "mpc-paper", "controller_options": {"horizon": horizon}}
        layer = Layer("test", {"vehicle": {"profile": path}, **own})
        margins.append(model_margin(load([layer])[0].each_ego()[0], H))
    assert margins == pytest.approx([0.7, 0.7, 4 * 0.7])


# ---- a run ----


def test_a_run_tells_the_identified_model_and_keeps_the_profile(zoo, profile, own_temp):
    car = zoo.car()
    path = profile(car=car, **IDENTIFIED | {"mass": 1000.0, "friction": 100.0})
    vehicle = {"fmu": str(car), "profile": str(path), "isolation": "none"}
    result = library.run({"time_limit": 3.0, "vehicle": vehicle})
    assert any("identified M = 1000 kg, alpha = 100 N.s/m" in remark for remark in result.remarks)
    recorded = str(result.manifest)
    assert "'position_error': 0.7" in recorded
    assert not list(own_temp.iterdir())


@pytest.mark.parametrize("key", ["fmu", "profile"])
def test_files_that_are_missing_are_refused_before_the_run(zoo, tmp_path, key):
    vehicle = {"fmu": str(zoo.car())} | {key: str(tmp_path / "missing")}
    with pytest.raises((VehicleError, ConfigError), match="missing: no such file"):
        library.run({"vehicle": vehicle})
