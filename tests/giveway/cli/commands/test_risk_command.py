"""The command ``giveway risk``, as a user types it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from giveway.cli.program import main

SHORT = ["risk", "shared_space", "--fix", "crowd.pedestrians=1", "--fix", "time_limit=0.5"]


def typed(monkeypatch, *arguments):
    monkeypatch.setattr("sys.argv", ["giveway", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        main()
    return ended.value.code


def test_without_the_event_the_upper_bound_is_printed_and_written(monkeypatch, tmp_path, capsys):
    out = tmp_path / "out"
    assert typed(monkeypatch, *SHORT, "--runs", 3, "--jobs", 1, "--out", out) in {0, None}
    said = " ".join(capsys.readouterr().out.split())
    assert "Probability of the event 'frontal' by monte-carlo: 0 of 3 runs have it" in said
    assert "per run - 0 0.632" in said
    assert "The event was not met: the upper bound is one-sided" in said
    assert (out / "figures" / "convergence.png").stat().st_size > 1000
    assert typed(
        monkeypatch, *SHORT, "--runs", 3, "--jobs", 1, "--out", out, "--resume", "--json"
    ) in {0, None}
    told = json.loads(capsys.readouterr().out)
    assert (told["runs"], told["events"], told["low"]) == (3, 0, 0.0)


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (["--event", "frontel"], "event = 'frontel': expected one of frontal"),
        (["--random", "vehicle.mass=gauss:1,2"], "no distribution is called 'gauss'"),
        (["--fix", "crowd.pedestrians=0"], "nothing is random"),
        (["--method", "subset", "--runs", "10"], "expected a budget of at least 3000"),
        (["--method", "importance", "--runs", "10"], "expected a budget of at least 200"),
    ],
)
def test_what_cannot_be_estimated_is_one_line(monkeypatch, tmp_path, capsys, flags, said):
    monkeypatch.chdir(tmp_path)
    assert typed(monkeypatch, *SHORT, *flags) == 2
    error = capsys.readouterr().err
    assert said in error
    assert len(error.splitlines()) == 1
    assert not [*Path().iterdir()]
