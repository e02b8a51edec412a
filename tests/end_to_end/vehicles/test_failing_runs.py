"""Runs whose FMU fails on the road: one line, the rows so far, nothing left behind."""

from __future__ import annotations

import importlib.util
import json
import re
import signal
from pathlib import Path

import pandas as pd
import pytest

SEED = 4
AT = 4.0  # [s] later than anything that is driven before the run
WORDS = (
    "run",
    "shared_space",
    "--seed",
    SEED,
    "--crowd-preset",
    "SIM",
    "--out",
    "r",
    "--no-pictures",
)
FAILURES = {
    "segfault": ("1.0", r"SIGSEGV"),
    "exit_0": ("3.0", r"exit\(0\)"),
    "sleep_forever": ("2.0", r"no answer within 1 s"),
    "error": ("3.0", r"the axle broke"),
    "discard_always": ("2.0", r"discard"),
    "terminate": ("3.0", r"end"),
    "nan": ("2.0", r"speed = nan"),
    "jump": ("1.0", r"position = [\d.]+ m"),
}


def the_line(done, car) -> str:
    """The one line on stderr, which names the FMU."""
    assert done.returncode not in (0, None)
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("error: ")
    assert line.isprintable()
    assert str(car) in line or car.name in line
    return line


@pytest.fixture(params=["here", "outside"])
def typed(request):
    """Types a command in this process, or as a user does."""
    return request.getfixturevalue("giveway" if request.param == "here" else "giveway_outside")


@pytest.mark.parametrize(
    ("fault", "typed"),
    [*((fault, "here") for fault in FAILURES), ("segfault", "outside")],
    indirect=["typed"],
)
def test_a_run_ends_at_the_step_that_failed(zoo, typed, profiled, tmp_path, fault):
    fmi, says = FAILURES[fault]
    car = zoo.car(fmi=fmi, behaviour=fault, at=AT)
    profile = profiled(car, fmu={"step_timeout": 1.0})
    done = typed(*WORDS, "--vehicle", car, "--profile", profile)
    line = the_line(done, car)
    assert pytest.approx(AT, abs=0.051) in times_in(line)
    assert_says(line, says)
    rows = pd.read_csv(tmp_path / "r" / "ego.csv")
    assert rows["time"].iloc[-1] == pytest.approx(AT, abs=0.051)
    assert rows["speed"].between(-1.0, 10.0).all()
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text(encoding="utf-8"))
    assert "completed" not in json.dumps(manifest.get("outcome", ""))


def test_a_position_that_stands_at_a_positive_speed_ends_the_run(zoo, giveway, tmp_path):
    car = zoo.car(behaviour="position_stands", at=AT)
    profile = car.with_suffix(".toml")
    words = ("--profile", profile, "--vehicle-isolation", "none", "--time-limit", 12)
    line = the_line(giveway(*WORDS, "--vehicle", car, *words), car)
    assert_says(line, r"position has moved by .* where speed accounts for .*units")
    assert 80 <= len(pd.read_csv(tmp_path / "r" / "ego.csv")) <= 100


def test_ten_megabytes_of_talk_change_nothing(zoo, giveway, tmp_path):
    """5 MB a step to stdout, and messages."""
    at = 14.0  # [s] the checks before a run drive for longer than AT, and need not be flooded
    car = zoo.car(behaviour=["flood_stdout", "message_control"], at=at)
    done = giveway(
        *WORDS, "--time-limit", at + 0.1, "--vehicle", car, "--profile", car.with_suffix(".toml")
    )
    assert done.returncode == 0, done.stderr
    assert len(done.stdout) < 20_000
    assert "\x1b[2J" not in done.stdout + done.stderr
    assert pd.read_csv(tmp_path / "r" / "ego.csv")["time"].iloc[-1] > at


def test_an_fmu_that_kills_its_parent_hits_no_run(zoo, giveway_outside):
    car = zoo.car(behaviour="kill_parent", at=AT)
    words = ("--time-limit", AT + 1.0)
    done = giveway_outside(*WORDS, *words, "--vehicle", car, "--profile", car.with_suffix(".toml"))
    assert done.returncode == 0, done.stderr


def test_in_our_own_process_an_error_is_as_clear(zoo, giveway, tmp_path):
    car = zoo.car(behaviour="error", at=AT)
    words = ("--profile", car.with_suffix(".toml"), "--vehicle-isolation", "none")
    line = the_line(giveway(*WORDS, "--vehicle", car, *words), car)
    assert_says(line, r"no step from 4 s to 4\.05 s .*the axle broke")
    assert (tmp_path / "r" / "ego.csv").is_file()


def test_a_segfault_in_our_own_process_keeps_the_rows(zoo, giveway_outside, tmp_path):
    """Nobody can go on then; giveway's supervisor still says what happened."""
    car = zoo.car(behaviour="segfault", at=AT)
    words = ("--profile", car.with_suffix(".toml"), "--vehicle-isolation", "none")
    done = giveway_outside(*WORDS, "--vehicle", car, *words, cleans_up=False)
    assert done.returncode not in (0, -signal.SIGSEGV)
    assert "error: " in done.stderr
    assert len(pd.read_csv(tmp_path / "r" / "ego.csv")) > 70


@pytest.mark.parametrize(
    ("options", "tables", "says"),
    [
        ({"units": {"force": ("kg", 1.0, 0.0)}}, {}, r"kg.*mass"),
        ({"units": {"speed": None}}, {}, r"\[outputs\.speed\].*unit = \"m/s\""),
        ({}, {"inputs": {"force": {"variable": "forse"}}}, r"forse.*did you mean 'force'"),
        ({}, {"outputs": {"speed": {"variable": "mass"}}}, r"mass.*expected an output"),
        ({"wrong_token": True}, {}, r"the token is that of another model"),
        ({"behaviour": "abort", "phase": "load"}, {}, r"SIGABRT"),
        ({"behaviour": "error", "phase": "initialise"}, {}, r"the axle broke"),
        ({"spoken": {"speed": (1 / 3.6, 0.0)}}, {}, r"start at 4 m/s, but speed = 14\.4 m/s"),
        ({"euler": True, "values": {"lag": 0.02}}, {}, r"do not converge.*step = 0\.0\d+"),
        ({"spoken": {"force": (-1.0, 0.0)}}, {}, r"slows it down.*gain = -1\.0"),
        (
            {"spoken": {"speed": (1 / 3.6, 0.0)}, "initial": ()},
            {},
            r"position has moved by .* where speed accounts for .*units",
        ),
    ],
)
def test_an_unfit_fmu_is_refused_in_one_line(zoo, giveway, profiled, options, tables, says):
    car = zoo.car(**{"at": 0.0, **options})
    done = giveway(*WORDS, "--vehicle", car, "--profile", profiled(car, **tables))
    assert_says(the_line(done, car), says)


def test_the_diverging_fmu_of_a_real_tool_is_no_success(giveway, tmp_path):
    spec = importlib.util.find_spec("gemseo_fmu")
    if spec is None or spec.origin is None:
        pytest.skip("pip install --no-deps gemseo-fmu")
    fmu = Path(spec.origin).parent / "problems" / "fmu_files" / "linux" / "Mass_Damper.fmu"
    profile = tmp_path / "car.toml"
    profile.write_text(
        '[inputs.force]\nvariable = "f"\n'
        '[outputs.speed]\nvariable = "mass.v"\n[outputs.position]\nvariable = "mass.s"\n'
    )
    line = the_line(giveway(*WORDS, "--vehicle", fmu, "--profile", profile), fmu)
    assert_says(line, r"do not converge")


@pytest.mark.parametrize(
    ("options", "note"),
    [
        ({"values": {"mass": 2000.0}}, r"identified M = 2\d\d\d kg, .* coarsely"),
        ({"values": {"mass": 3000.0}}, r"identified M = [23]\d\d\d kg, .* coarsely"),
        ({"initial": ()}, "no parameter for the initial speed: driven up to 4"),
    ],
)
def test_a_run_that_goes_on_notes_what_is_odd(zoo, giveway, options, note):
    car = zoo.car(**options)
    words = ("--time-limit", 8, "--profile", car.with_suffix(".toml"))
    done = giveway(*WORDS, "--vehicle", car, *words)
    assert done.returncode == 0, done.stderr
    assert re.search(note, " ".join(done.stdout.split()))


def test_a_study_drives_what_a_run_identifies(zoo, giveway, tmp_path):
    car = zoo.car(values={"mass": 2000.0})
    run = {"scenario": "shared_space", "time_limit": 6.0, "crowd.preset": "SIM"}
    run |= {"vehicle.fmu": str(car), "vehicle.profile": str(car.with_suffix(".toml"))}
    lines = [f"{key} = {json.dumps(value)}" for key, value in run.items()]
    study = ['name = "cars"', "replications = 1", "[run]", *lines]
    study += ["[factors]", 'controller = ["pid-tuned", "mpc"]']
    (tmp_path / "cars.toml").write_text("\n".join(study))
    done = giveway("study", "cars.toml", "--out", "cars", "--jobs", 1, "--no-report", "-q")
    assert done.returncode == 0, done.stderr
    again = giveway("rerun", "cars", "c1-s1", "--no-pictures")
    assert (again.returncode, again.stderr) == (0, "")
    assert "identified M = 2" in " ".join(again.stdout.split())


@pytest.mark.parametrize(
    ("options", "flags", "said"),
    [
        (
            {"spoken": {"speed": (1 / 3.6, 0.0)}, "initial": (), "outputs": ("speed",)},
            (),
            r"does it weigh that\?",
        ),
        ({"values": {"mass": 2000.0}}, ("--vehicle-mass", 900), r"--vehicle-mass 2\d\d\d"),
        (
            {"role": "drive_brake", "spoken": {"brake_force": (-1.0, 0.0)}},
            (),
            r"braking makes it faster; .* gain = -1\.0 in \[inputs\.brake_force\]",
        ),
        ({"values": {"engaged": 0.0}}, (), r"gear, ignition"),
        ({"behaviour": "frozen", "at": AT, "outputs": ("speed",)}, (), r"no force moves it"),
    ],
)
def test_a_vehicle_that_cannot_stop_or_is_another_is_refused(zoo, giveway, options, flags, said):
    car = zoo.car(**options)
    profile = ("--profile", car.with_suffix(".toml"), *flags)
    assert_says(the_line(giveway(*WORDS, "--vehicle", car, *profile), car), said)


def test_a_force_limit_that_cannot_stop_the_mass_is_refused(giveway):
    done = giveway("run", "encounter", "--vehicle-mass", 40_000, "--vehicle-force-limit", 2000)
    assert done.returncode == 2
    assert "expected 3 m/s2 or more: write --vehicle-force-limit 320000" in done.stderr


def times_in(line: str) -> list[float]:
    return [float(number) for number in re.findall(r"(\d+(?:\.\d+)?) s\b", line)]


def assert_says(line: str, pattern: str) -> None:
    assert re.search(pattern, line), line
