"""``giveway fmu identify`` as a user types it: the numbers, the profile, the picture."""

from __future__ import annotations

import tomllib

import pytest

from fmus import bundled_fmu
from fmus.profile.vehicle_profile import read_profile
from giveway.cli import main


@pytest.fixture
def identify(monkeypatch, capsys, tmp_path):
    """Runs the command in tmp_path: its exit code, what it printed, what it complained of."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        with pytest.raises(SystemExit) as ended:
            main(["fmu", "identify", *map(str, words)])
        return ended.value.code, *capsys.readouterr()

    return run


def test_ours_is_found_and_written(identify, tmp_path):
    code, _out, err = identify(bundled_fmu(), "-o", "ours.toml", "--picture", "fit.png")
    assert code == 0, err
    model = read_profile(tmp_path / "ours.toml").model
    assert model is not None
    assert (model.mass, model.friction) == pytest.approx((1000.0, 100.0), rel=1e-6)
    assert (tmp_path / "fit.png").read_bytes().startswith(b"\x89PNG")


def test_the_users_profile_gets_its_model_and_keeps_its_words(identify, capsys, zoo, tmp_path):
    path = zoo.car(values={"mass": 1400.0, "friction": 60.0, "lag": 0.2, "holds": 1.0})
    profile = tmp_path / "car.toml"
    text = "# my car\n" + path.with_suffix(".toml").read_text(encoding="utf-8")
    profile.write_text(text, encoding="utf-8")
    code, out, err = identify(path, "--profile", profile, "-o", profile)
    assert code == 0, err
    written = profile.read_text(encoding="utf-8")
    assert written.startswith(text.rstrip("\n"))
    model = tomllib.loads(written)["model"]
    assert model["mass"] == pytest.approx(1400.0, rel=0.01)
    assert model["friction"] == pytest.approx(60.0, rel=0.05)
    assert model["lag"] == pytest.approx(0.2, rel=0.05)
    assert "0.2 s late" in out
    with pytest.raises(SystemExit) as ended:
        main(["fmu", "check", str(path), "--profile", str(profile), "--out", str(tmp_path)])
    assert ended.value.code == 0
    assert "\nPassed.\n" in capsys.readouterr().out


def test_a_foreign_file_is_not_overwritten(identify, zoo, tmp_path):
    path = zoo.car()
    (tmp_path / "notes.toml").write_text("mine = 1\n", encoding="utf-8")
    words = (path, "--profile", path.with_suffix(".toml"), "-o", "notes.toml")
    code, _out, err = identify(*words)
    assert code == 2
    assert err == (
        "error: notes.toml: exists; name another file with -o, or replace it with --force\n"
    )
    assert (tmp_path / "notes.toml").read_text(encoding="utf-8") == "mine = 1\n"


@pytest.mark.parametrize(
    ("car", "words"),
    [
        ({"behaviour": "abort"}, "SIGABRT|abort"),
        ({"values": {"engaged": 0.0}}, "expected a vehicle that drives off"),
        ({"spoken": {"force": (-1.0, 0.0)}}, "gain = -1.0"),
        ({"euler": True, "values": {"lag": 0.02}}, "add `step = 0.025` to \\[fmu\\]"),
    ],
)
def test_what_cannot_be_identified_is_one_line(identify, zoo, tmp_path, car, words):
    path = zoo.car(**car)
    code, _out, err = identify(path, "--profile", path.with_suffix(".toml"), "-o", "x.toml")
    assert code == 1
    assert err.startswith(f"error: {path}: ")
    assert err.count("\n") == 1
    assert any(part in err for part in words.replace("\\", "").split("|"))
    assert not (tmp_path / "x.toml").exists()


def test_a_sign_that_the_profile_turns_already_is_turned_back(identify, zoo, tmp_path):
    path = zoo.car()
    text = path.with_suffix(".toml").read_text(encoding="utf-8")
    turned = tmp_path / "turned.toml"
    turned.write_text(text.replace("[inputs.force]\n", "[inputs.force]\ngain = -1\n"), "utf-8")
    code, _out, err = identify(path, "--profile", turned)
    assert code == 1
    assert "`gain = 1.0` in place of `gain = -1.0` in [inputs.force]" in err
