"""The command line as a user types it: real SUMO, and where it matters real processes."""

import contextlib
import io
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from giveway.processes.heartbeat import Heartbeat

Typed = subprocess.CompletedProcess[str]
Type = Callable[..., Typed]


@pytest.fixture
def refused(type_here: Type) -> Callable[..., str]:
    """The one line on stderr of a command that must fail."""

    def type_(*words: object) -> str:
        done = type_here(*words)
        assert done.returncode == 2, done.stderr
        lines = done.stderr.strip().splitlines()
        assert len(lines) == 1, done.stderr
        assert lines[0].startswith("error: ")
        return lines[0]

    return type_


def test_the_readmes_run(type_outside: Type, tmp_path: Path) -> None:
    words = [
        "run",
        "shared_space",
        "--pedestrians",
        "30",
        "--seed",
        "1",
        "--controller",
        "mpc-paper",
    ]
    done = type_outside(*words)
    assert done.returncode == 0, done.stderr
    assert "Time to the goal" in done.stdout
    assert len(done.stdout.splitlines()) < 40  # one screen
    (folder,) = (tmp_path / "results").iterdir()
    assert folder.name == "shared_space_mpc-paper_30ped_seed1"
    assert (folder / "trajectories.csv").stat().st_size > 100_000
    assert not done.stderr


def test_a_run_in_which_nobody_is_has_a_summary(type_here: Type) -> None:
    words = ("--pedestrians", 0, "--no-ego", "--time-limit", 1, "--no-pictures", "--explain")
    done = type_here("run", "shared_space", *words)
    assert done.returncode == 0, done.stderr
    assert "Real-time factor" in done.stdout


def test_a_folder_counts_nobody_where_the_scenario_brings_people(
    type_here: Type, tmp_path: Path
) -> None:
    words = ("--pedestrians", 0, "--time-limit", 0.1, "--no-pictures", "-q")
    assert type_here("run", "shared_space", *words).returncode == 0
    (folder,) = (tmp_path / "results").iterdir()
    assert folder.name == "shared_space_mpc_time-limit-0.1_seed1"


def test_a_missing_vehicle_is_said_before_results_that_exist(
    refused: Callable[..., str], tmp_path: Path
) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "ego.csv").touch()
    line = refused("run", "shared_space", "--vehicle", "no.fmu", "--out", "there")
    assert "no.fmu: no such file" in line


def test_flags_override_the_file_and_the_file_the_scenario(type_here: Type, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text("seed = 7\n[crowd]\npedestrians = 5\n")
    done = type_here("config", "shared_space", "--config", "study.toml", "--seed", 8)
    assert re.search(r"^seed = 8\b", done.stdout, re.M)
    assert re.search(r"^pedestrians = 5\b", done.stdout, re.M)
    assert re.search(r'^route = \["plaza"\]', done.stdout, re.M)


def test_version_and_scenarios(type_here: Type) -> None:
    assert type_here("--version").stdout.startswith("giveway 0.")
    listed = type_here("scenarios").stdout
    assert "shared_space" in listed
    assert "street" in listed


def test_unknown_things_are_guessed_at(refused: Callable[..., str], tmp_path: Path) -> None:
    assert "--pedestrians" in refused("run", "--pedestrains", 3)
    assert "'run'" in refused("rnu")
    assert "shared_space" in refused("run", "shared_spcae")
    (tmp_path / "study.toml").write_text("[crowd]\npedestrans = 5\n")
    message = refused("run", "--config", "study.toml")
    assert "study.toml: [crowd] pedestrans" in message
    assert "'pedestrians'" in message


def test_a_supervised_run_that_is_refused_is_one_line_too(type_outside: Type) -> None:
    done = type_outside("run", "--pedestrians", -1)
    assert done.returncode == 2
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("error: ")
    assert "[persons]" in line


def test_absurd_values_are_refused_with_their_unit(refused: Callable[..., str]) -> None:
    assert "[m/s]" in refused("run", "--ego-initial-speed", 1e9)
    assert "[persons]" in refused("run", "--pedestrians", -1)
    assert "--pedestrians = 'many'" in refused("run", "--pedestrians", "many")
    assert "[kg]" in refused("run", "--vehicle-mass", 0)
    assert "[s]" in refused("run", "--time-step", 0.03)


def test_the_safety_layer_has_a_switch_like_any_other(type_here: Type) -> None:
    for flag, value in (("--safety", True), ("--no-safety", False)):
        run = type_here("config", "--controller", "mpc-paper", flag)
        assert tomllib.loads(run.stdout)["safety"]["enabled"] is value
    plain = type_here("config", "--controller", "mpc-paper")
    assert "enabled" not in tomllib.loads(plain.stdout)["safety"]


def test_a_broken_scenario_carries_sumos_own_reason(
    refused: Callable[..., str], tmp_path: Path
) -> None:
    (tmp_path / "broken.sumocfg").write_text(
        '<configuration><input><net-file value="missing.net.xml"/></input></configuration>'
    )
    (tmp_path / "broken.giveway.toml").write_text('[ego]\nroute = ["a"]\n')
    message = refused("run", "broken.sumocfg", "--pedestrians", 0)
    assert "broken.sumocfg" in message
    assert "missing.net.xml" in message
    (tmp_path / "broken.sumocfg").write_text("<configuration><input>")
    message = refused("run", "broken.sumocfg", "--pedestrians", 0)
    assert "broken.sumocfg" in message


def test_an_ego_route_that_is_not_there_is_named(refused: Callable[..., str]) -> None:
    assert "'plazza'" in refused("run", "--ego-route", "plazza")
    assert "edge 'plaza' has 1 lane" in refused("run", "--ego-lane", 3)
    assert "--ego-travel-distance" in refused("run", "--ego-travel-distance", 4000)
    assert "'gaate'" in refused("run", "--crowd-host-edge", "gaate")


def test_a_missing_or_broken_fmu_is_named(refused: Callable[..., str], tmp_path: Path) -> None:
    assert "car.fmu" in refused("run", "--vehicle", "car.fmu")
    (tmp_path / "car.fmu").write_bytes(b"not an archive")
    assert "car.fmu" in refused("run", "--vehicle", "car.fmu")


def test_existing_results_need_force(type_here: Type, refused: Callable[..., str]) -> None:
    words = ("run", "--pedestrians", 0, "--no-pictures", "-q", "--out", "r")
    assert type_here(*words).returncode == 0
    assert "--force" in refused(*words)
    assert type_here(*words, "--force").returncode == 0


def test_an_unwritable_results_folder_is_named(refused: Callable[..., str], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "file/r" in refused("run", "--pedestrians", 0, "--out", "file/r")


def step_of(journal: Path) -> int:
    """How far a run is, by its heartbeat."""
    with contextlib.suppress(OSError):
        return Heartbeat(journal).read().step
    return 0


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_ctrl_c_keeps_the_rows_and_exits_130(tmp_path: Path) -> None:
    words = ["--pedestrians", "1000", "--spawn-area", "20,-200,120,-10", "--out", "r"]
    words += ["--ego-travel-distance", "70", "--no-pictures"]
    words += ["--desired-speed", "0.2"]  # it takes its time
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "giveway", "run", *words],
        cwd=tmp_path,
        env=os.environ | {"TMPDIR": str(tmp_path)},  # the journal, to be watched
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    started = time.monotonic()
    while not any(step_of(journal) > 5 for journal in tmp_path.glob("giveway-journal-*")):
        assert time.monotonic() - started < 200
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=180)
    assert process.returncode == 130
    assert "interrupted" in errors
    rows = (tmp_path / "r" / "ego.csv").read_text().splitlines()
    assert len(rows) > 2
    assert '"ending": "interrupted"' in (tmp_path / "r" / "manifest.json").read_text()


def test_the_influence_picture(
    type_here: Type, refused: Callable[..., str], tmp_path: Path
) -> None:
    assert type_here("plot", "influence", "--out", "f.png").returncode == 0
    assert (tmp_path / "f.png").read_bytes().startswith(b"\x89PNG")
    assert "--speeds" in refused("plot", "influence", "--speeds", "fast")
    assert "SIM" in refused("plot", "influence", "--preset", "SIMM")


def test_a_terminal_without_our_characters_is_no_error(
    type_here: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = io.BytesIO()
    terminal = io.TextIOWrapper(shown, encoding="ascii", write_through=True)
    monkeypatch.setattr(sys, "stdout", terminal)
    done = type_here("run", "--pedestrians", 0, "--no-pictures")
    assert done.returncode == 0, done.stderr
    assert b"Time to the goal" in shown.getvalue()
