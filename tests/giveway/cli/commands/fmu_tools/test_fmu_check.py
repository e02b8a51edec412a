"""``giveway fmu check`` as a user types it: the table, the exit code, the picture."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from fmus import bundled_fmu
from giveway.cli import main

PNG = b"\x89PNG"


@pytest.fixture
def giveway(monkeypatch, capsys, tmp_path):
    """Runs a command line in tmp_path: its exit code, what it printed, what it complained of."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")

    def run(*words):
        with pytest.raises(SystemExit) as ended:
            main([str(word) for word in words])
        return ended.value.code, *capsys.readouterr()

    return run


@pytest.fixture
def checked(giveway):
    return lambda path, *words: giveway("fmu", "check", path, "--out", ".", *words)


def test_ours_passes_and_is_drawn(checked, tmp_path):
    code, out, err = checked(bundled_fmu())
    assert code == 0, out + err
    assert "Passed." in out
    assert "fail" not in out
    assert (tmp_path / f"{bundled_fmu().stem}_check.png").read_bytes().startswith(PNG)


def test_a_car_with_its_profile_passes(checked, zoo, tmp_path):
    path = zoo.car(fmi="3.0", kind="model-exchange", role="drive_brake")
    code, out, err = checked(path, "--profile", path.with_suffix(".toml"))
    assert code == 0, out + err


def test_a_fault_comes_with_the_line_that_mends_it(checked, zoo, tmp_path):
    path = zoo.car(spoken={"force": (-1.0, 0.0)})
    code, out, _ = checked(path, "--profile", path.with_suffix(".toml"))
    assert code == 1
    assert "write `gain = -1.0` in [inputs.force]: tried" in " ".join(out.split())
    assert "failed" in out
    text = path.with_suffix(".toml").read_text(encoding="utf-8")
    mended = tmp_path / "mended.toml"
    mended.write_text(
        text.replace("[inputs.force]\n", "[inputs.force]\ngain = -1.0\n"), encoding="utf-8"
    )
    code, out, err = checked(path, "--profile", mended)
    assert code == 0, out + err


@pytest.mark.parametrize("behaviour", ["segfault", "nan"])
def test_a_hostile_fmu_fails_without_a_traceback(checked, zoo, tmp_path, behaviour):
    path = zoo.car(behaviour=behaviour)
    code, out, err = checked(path, "--profile", path.with_suffix(".toml"))
    assert code == 1
    assert "fail" in out
    assert "Traceback" not in out + err
    assert err == ""


def test_an_fmu_that_is_none_fails(checked, tmp_path):
    path = tmp_path / "car.fmu"
    path.write_bytes(b"not a zip")
    code, out, _err = checked(path)
    assert code == 1
    assert "fail" in out
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["missing.fmu"], "error: missing.fmu: no such file; expected an FMU"),
        ([bundled_fmu(), "--profile", "missing.toml"], "error: missing.toml: no such file"),
    ],
)
def test_a_bad_request_is_one_line_and_exit_code_2(giveway, tmp_path, words, line):
    code, _, err = giveway("fmu", "check", *words)
    assert code == 2
    assert err.startswith(line)
    assert err.count("\n") == 1


def test_the_mass_and_damper_of_openmodelica_is_no_success(checked, tmp_path):
    found = importlib.util.find_spec("gemseo_fmu")
    if found is None or found.origin is None:
        pytest.skip("gemseo-fmu is not installed: pip install --no-deps gemseo-fmu")
    path = Path(found.origin).parent / "problems/fmu_files/linux/Mass_Damper.fmu"
    profile = tmp_path / "spring.toml"
    profile.write_text(
        '[inputs.force]\nvariable = "f"\n[outputs.speed]\nvariable = "mass.v"\n'
        '[outputs.position]\nvariable = "mass.s"\n',
        encoding="utf-8",
    )
    code, out, _err = checked(path, "--profile", profile)
    assert code == 1
    assert "50 ms do not converge" in " ".join(out.split())


def test_a_wrong_unit_of_pedals_fails_by_the_class_of_the_ego(checked, zoo):
    spoken = {"throttle": (0.01, 0.0), "brake": (0.01, 0.0)}
    path = zoo.car(role="throttle_brake", spoken=spoken)
    profile = path.with_suffix(".toml")
    code, out, _ = checked(path, "--profile", profile, "--ego-class", "passenger")
    assert code == 1
    line = '`unit = "%"` in [inputs.throttle] and `unit = "%"` in [inputs.brake]: tried'
    assert line in " ".join(out.split())


def test_a_class_that_sumo_does_not_know_is_one_line(giveway, zoo):
    code, _, err = giveway("fmu", "check", zoo.car(), "--ego-class", "spaceship")
    assert code == 2
    assert err.startswith("error: --ego-class spaceship: expected one of passenger, ")
