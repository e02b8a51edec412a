"""Recorded people in a run, through the real SUMO, FMU and solver."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

import giveway
from giveway.errors import ConfigError, DatasetError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

# Starts [m] and velocities [m/s]: two cross the ego's way before it comes, one walks into its side
# at once, one later, one meets it head-on, and one is far away. The ego's front starts at x = 2.5 m
# with 4 m/s, along y = 0.
WALKS = (
    ((12.0, -4.0), (0.0, 1.4)),
    ((14.0, 4.0), (0.0, -1.3)),
    ((3.0, -1.9), (0.0, 1.3)),
    ((17.0, -6.9), (0.0, 1.3)),
    ((40.0, 0.3), (-1.2, 0.0)),
    ((30.0, -25.0), (1.0, 0.2)),
)
FRAMES = 400  # 13 s
NEVER = {"time": 0.0, "distance": 0.0}
TABLES = ("ego", "trajectories", "pedestrians", "summary")


@pytest.fixture
def run(tmp_path: Path, write_clip: Callable, straight_walks: Callable) -> Callable:
    """Run the plaza with the recorded people: (model, model_options, **settings) -> result."""
    starts, velocities = map(list, zip(*WALKS, strict=True))
    path = write_clip(tmp_path / "clips", "yard", *straight_walks(FRAMES, starts, velocities))

    def make(model: str = "vci", options: dict | None = None, **settings: Any) -> Any:
        entry = {"name": "yard", "path": str(path), "dataset": "citr"} | settings.pop("entry", {})
        crowd = {"pedestrians": 0, "model": model, "recorded": [entry], "preset": "SIM"}
        base = {"scenario": "shared_space", "controller": "pid-tuned", "model_options": options}
        config = base | {"crowd": crowd, "record": {"near": 500.0}, "model_options": options or {}}
        results = settings.pop("results", None)
        return giveway.run(config | settings, results=results, pictures=False)

    return make


def tracks(result: Any) -> dict[str, pd.DataFrame]:
    """Return the rows of each pedestrian, by id."""
    people = result.trajectories.query("type == 'pedestrian'")
    return {str(name): rows for name, rows in people.groupby("id")}


def off_the_line(number: int, rows: pd.DataFrame) -> np.ndarray:
    """Return the distance [m] of each row from where the person was recorded then."""
    (x, y), (vx, vy) = WALKS[number]
    time = rows["time"].to_numpy()
    apart = rows["x"] - (x + vx * time), rows["y"] - (y + vy * time)
    return np.hypot(*apart).to_numpy()


def test_simulated_people_enter_as_recorded(run: Callable) -> None:
    result = run(entry={"begin": -1.0})
    assert result.ending == "completed"
    for number, rows in enumerate(tracks(result).values()):
        first = rows.iloc[0]
        (x, y), (vx, vy) = WALKS[number]
        assert (first.time, first.x, first.y) == pytest.approx((0.0, x + vx, y + vy), abs=1e-9)
        assert first.speed == pytest.approx(np.hypot(vx, vy))
        assert off_the_line(number, rows.assign(time=rows["time"] + 1.0)).max() > 0.01
    hashed = [name for name in result.manifest["inputs"] if name.startswith("recording ")]
    assert [name.partition(": ")[2] for name in hashed] == ["yard_traj_ped_filtered.csv"]


def test_people_without_a_hand_over_walk_as_recorded(run: Callable) -> None:
    result = run("recorded", NEVER)
    people = tracks(result)
    assert list(people) == [f"yard.{number + 1}" for number in range(len(WALKS))]
    for number, rows in enumerate(people.values()):
        assert off_the_line(number, rows).max() < 1e-6
    assert result.summary["handed_over"] == 0


def test_who_drives_into_a_scripted_person_has_a_frontal_contact() -> None:
    person = {"name": "dummy", "x": 12.0, "y": -3.0, "heading": 90.0, "speed": 1.4}
    crowd = {"pedestrians": 0, "model": "recorded", "scripted": [person]}
    drive = {"controller": "speed-holder", "safety": {"enabled": False}, "time_limit": 5.0}
    run = giveway.run({"scenario": "shared_space", "crowd": crowd, **drive}, pictures=False)
    assert run.pedestrians["contact"].tolist() == ["frontal"]
    assert run.summary["recorded_contacts"] == 0


def test_contacts_with_people_who_do_not_react_count_apart(run: Callable) -> None:
    """A person walks into the side of the car, which cannot help it."""
    blind = run("recorded", NEVER)
    summary = blind.summary
    assert summary["recorded_contacts"] == summary["overlaps"] >= 1
    assert summary["frontal_contacts"] == summary["side_contacts"] == 0
    kinds = blind.pedestrians["contact"]
    assert (kinds == "recorded").sum() == summary["recorded_contacts"]
    assert (blind.pedestrians["severity"] != "collision").all()
    judged = run("recorded", NEVER, entry={"judged": True}).summary
    assert judged["overlaps"] == summary["overlaps"]
    assert judged["frontal_contacts"] + judged["side_contacts"] == judged["overlaps"]
    assert judged["recorded_contacts"] == judged["handed_over"] == 0
    aware = run("recorded").summary
    assert aware["recorded_contacts"] == 0
    assert aware["handed_over"] >= 4


def test_the_model_takes_over_when_the_ego_is_near(run: Callable) -> None:
    result = run("recorded", {"time": 0.0, "distance": 3.0})
    handed = 0
    for number, (_, rows) in enumerate(tracks(result).items()):
        away = off_the_line(number, rows) > 1e-6
        car = result.ego["x"].to_numpy()[: len(rows)]
        beyond = np.maximum(np.maximum(rows["x"] - car, car - 5.0 - rows["x"]), 0.0)
        beside = np.maximum(rows["y"].abs() - 1.0, 0.0)
        distance = np.hypot(beyond, beside).to_numpy()  # of the centre from the body
        if not (near := distance < 3.0).any():
            assert not away.any()
            continue
        handed += 1
        # the model's first step begins when the ego is near, and is seen one instant later
        assert away.argmax() == pytest.approx(near.argmax(), abs=1)
    assert result.summary["handed_over"] == handed >= 3


@pytest.mark.parametrize("scenario", ["shared_space", "street"])
def test_people_who_feel_no_vehicle_lose_nothing(run: Callable, scenario: str) -> None:
    """The counterfactual run has the very same people, on open ground and with SUMO."""
    speed = {"regulation": {"reference_speed": 4.0}}
    result = run("recorded", NEVER, scenario=scenario, twin=True, entry={"x": 40.0}, **speed)
    delays = result.pedestrians["delay"].dropna()
    assert len(delays) >= 3
    assert delays.abs().max() == pytest.approx(0.0, abs=1e-9)


def test_handed_over_people_lose_time_to_the_recording(run: Callable) -> None:
    result = run("recorded", twin=True)
    assert result.effect is not None
    assert result.pedestrians["delay"].abs().max() > 0.1


@pytest.mark.parametrize("model", ["vci", "recorded"])
def test_equal_runs_have_equal_bytes(run: Callable, tmp_path: Path, model: str) -> None:
    for name, seed in (("one", 1), ("same", 1), ("seed", 2)):
        run(model, seed=seed, twin=True, results=tmp_path / name)
    for table in TABLES:
        one, same, seed = (
            (tmp_path / name / f"{table}.csv").read_bytes() for name in ("one", "same", "seed")
        )
        assert one == same
        assert (one == seed) == (table != "summary")  # nothing is drawn; the summary has the seed


def test_a_wrong_recording_ends_before_the_run(run: Callable, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"'yard': x = 5000, y = 0: its people walk"):
        run(entry={"x": 5000.0})
    with pytest.raises(DatasetError, match="no such file or folder"):
        run(entry={"path": str(tmp_path / "nowhere")})
    with pytest.raises(ConfigError, match="clip = 'lawn': not in "):
        run(entry={"clip": "lawn"})


STUDY = """
name = "recorded"
replications = 4
[run]
scenario = "recorded"
crowd.preset = "SIM" # whose people do not sway
[factors]
controller = ["mpc", "pid-tuned"]
"crowd.model" = ["recorded", "vci"]
[comparison]
minimum_pairs = 3
resamples = 99
"""


def test_the_bundled_recording_runs_and_no_worker_changes_a_byte(
    study_of: Callable, tmp_path: Path
) -> None:
    alone = study_of(STUDY, tmp_path / "alone")
    worker = study_of(STUDY, tmp_path / "worker", jobs=1)
    tables = [study.path / "runs.csv" for study in (alone, worker)]
    assert tables[0].read_bytes() == tables[1].read_bytes()
    rows = pd.read_csv(tables[0])
    assert len(rows) == 16
    assert (rows["ending"] == "completed").all()
    # nothing is drawn: all seeds are equal, and the models are not
    times = rows.groupby(["controller", "crowd.model"])["completion_time"]
    assert (times.nunique() == 1).all()
    assert (rows["frontal_contacts"] == 0).all()
