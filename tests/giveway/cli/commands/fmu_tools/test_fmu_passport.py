"""``giveway fmu passport`` as a user types it: one JSON and one page."""

from __future__ import annotations

import json
from hashlib import sha256

import pytest

from fmus import bundled_fmu
from giveway.cli import main


@pytest.fixture
def passport(monkeypatch, capsys, tmp_path):
    """Runs the command in tmp_path: its exit code, what it printed, what it complained of."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        with pytest.raises(SystemExit) as ended:
            main(["fmu", "passport", *map(str, words)])
        return ended.value.code, *capsys.readouterr()

    return run


def test_it_says_what_the_vehicle_is_and_does(passport, tmp_path):
    path = bundled_fmu()
    code, out, err = passport(path, "-o", "mine")
    assert code == 0, err
    assert "The check has passed" in out
    known = json.loads((tmp_path / "mine" / "passport.json").read_text("utf-8"))
    assert known["fmu"]["sha256"] == sha256(path.read_bytes()).hexdigest()
    assert {finding["verdict"] for finding in known["check"]["findings"]} <= {"pass", "skip", "ask"}
    assert known["identification"]["mass"] == pytest.approx(1000.0, rel=1e-4)
    assert known["convergence"]["speed"] < 0.1
    assert known["beside_fmpy"]["speed"] < 1e-9
    assert known["beside_fmpy"]["problem"] == ""
    assert any("grades" in point for point in known["not_asked"])
    page = (tmp_path / "mine" / "passport.html").read_text("utf-8")
    assert page.count("<svg") == 2
    for words in (known["fmu"]["sha256"], "What was not asked", "start speed"):
        assert words in page
    assert "://" not in page


def test_what_fails_is_written_too(passport, zoo, tmp_path):
    car = zoo.car(behaviour="segfault", at=0.1)
    code, out, _err = passport(car, "--profile", car.with_suffix(".toml"), "-o", "mine")
    assert code == 1
    assert "no model was identified" in out
    known = json.loads((tmp_path / "mine" / "passport.json").read_text("utf-8"))
    assert not known["check"]["passed"]
    assert (
        "crashed" in known["identification"]["problem"]
        or "SIG" in known["identification"]["problem"]
    )
    assert known["beside_fmpy"]["problem"]


def test_an_fmu_that_is_none_is_one_line(passport, tmp_path):
    (tmp_path / "car.fmu").write_bytes(b"no archive")
    code, _out, err = passport("car.fmu")
    assert code != 0
    assert err.count("\n") == 1
    assert not (tmp_path / "results").exists()
