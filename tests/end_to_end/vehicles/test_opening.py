"""Before a run its FMU is fitted to its profile and driven in full and in half steps."""

from __future__ import annotations

import pytest
import tomlkit

import giveway as library
from giveway.errors import VehicleError

H = 0.05  # [s]


@pytest.fixture
def run(zoo, tmp_path, own_temp):
    """A short run of a car; nothing of it is left in the folder for temporary files."""

    def start(car, *, drafted=False, time_limit=1.0, isolation="none", **tables):
        profile = zoo.profile(car)
        for table, keys in tables.items():
            profile.setdefault(table, {}).update(keys)
        path = tmp_path / "car.toml"
        path.write_text(tomlkit.dumps(profile), encoding="utf-8")
        vehicle = {"fmu": str(car), "isolation": isolation}
        if not drafted:
            vehicle["profile"] = str(path)
        try:
            return library.run({"time_limit": time_limit, "vehicle": vehicle})
        finally:
            assert not list(own_temp.iterdir())

    return start


DIVERGING = {"euler": True, "values": {"lag": 0.02}}


@pytest.mark.parametrize("isolation", ["none", "process"])
def test_a_diverging_fmu_is_refused_with_the_line_to_add(zoo, run, isolation):
    car = zoo.car(**DIVERGING)
    with pytest.raises(VehicleError) as caught:
        run(car, isolation=isolation)
    message = str(caught.value)
    assert message.startswith(f"{car}: its steps of 50 ms do not converge")
    assert message.endswith("add `step = 0.025` to [fmu] of the profile")
    assert "\n" not in message


def test_with_that_line_it_drives(zoo, run):
    assert len(run(zoo.car(**DIVERGING), fmu={"step": 0.025}).ego) > 10


def test_without_the_comparison_it_must_still_drive_and_stop(zoo, run):
    with pytest.raises(VehicleError, match="against coasting"):
        run(zoo.car(**DIVERGING), fmu={"self_check": False})


def test_an_fmu_that_fails_at_every_step_is_left_to_the_run(zoo, run):
    """It fails in the check, too; but only the run has rows to keep."""
    car = zoo.car(behaviour="error", at=0.0)
    with pytest.raises(library.GivewayError) as caught:
        run(car)
    assert "the axle broke" in str(caught.value)
    assert "do not converge" not in str(caught.value)


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"outputs": {"speed": {"variable": "sped"}}}, "did you mean 'speed'?"),
        ({"inputs": {"force": {"variable": "force", "unit": "kg"}}}, "a mass, and not a force"),
        ({"fmu": {"kind": "model-exchange"}}, "has co-simulation only"),
        ({"fmu": {"step": 1e-9}}, "times smaller than the control step of 0.05 s"),
        ({"parameters": {"mass": "heavy"}}, "start value mass = heavy: expected a finite number"),
    ],
)
def test_a_profile_that_does_not_fit_is_refused_before_the_run(zoo, run, tables, said):
    with pytest.raises(VehicleError) as caught:
        run(zoo.car(), **tables)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_draft_that_leaves_no_doubt_needs_no_profile(zoo, run):
    assert len(run(zoo.car(), drafted=True).ego) > 10


def test_a_draft_with_a_doubt_is_refused_with_the_lines_to_add(zoo, run):
    with pytest.raises(VehicleError) as caught:
        run(zoo.car(units={"force": None}), drafted=True)
    assert "[inputs.force]" in str(caught.value)
    assert "unit" in str(caught.value)


def test_it_starts_at_the_egos_speed_without_a_parameter_for_it(zoo, run):
    result = run(zoo.car(initial=()))
    assert result.ego["speed"].iloc[0] == pytest.approx(4.0, abs=0.02)
    assert result.ego["position"].iloc[0] == 0.0
    assert any("driven up to" in remark for remark in result.remarks)


def test_an_fmu_with_the_wrong_sign_of_force_is_refused(zoo, run):
    car = zoo.car(spoken={"force": (-1.0, 0.0)})
    with pytest.raises(VehicleError, match=r"gain = -1\.0 in \[inputs\.force\]"):
        run(car)
