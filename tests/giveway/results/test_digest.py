"""The telling numbers of a run: few, in groups, and none that says nothing."""

from types import SimpleNamespace

import pandas as pd
import pytest

from giveway.results.digest import MOST, digest, worth_watching

QUIET = {
    "completion_time": 30.0,
    "mean_speed": 5.0,
    "stops": 0,
    "longest_wait": 0.0,
    "peak_deceleration": 0.0,
    "overlaps": 0,
    "frontal_contacts": 0,
    "close_passes": 0,
    "minimum_clearance": float("nan"),
    "minimum_ttc_moving": float("nan"),
    "people_below_ttc": 0,
    "safety_share": 0.0,
}
RULED = QUIET | {"red_lights_run": 0, "encounters": 0, "yielding_rate": float("nan")}
EVENTFUL = {
    **dict.fromkeys(RULED, 1.5),
    "sumo_time": 29.0,
    "encounters": 4,
    "yielding_rate": 0.75,
    "people_delay": 12.0,
    "failures_to_yield": 1,
    "blocked_crossings": 1,
    "blocked_junctions": 1,
    "stops_without_cause": 1,
    "vehicle_contacts": 1,
}


def _run(summary, *, ruled=False, people=(), columns=()):
    frame = pd.DataFrame(
        people,
        columns=[
            "id",
            "contact",
            "time_of_minimum_clearance",
            "minimum_ttc",
            "time_of_minimum_ttc",
        ],
    )
    ego = SimpleNamespace(
        summary=summary,
        ledger=object() if ruled else None,
        plain=None,
        measured=SimpleNamespace(columns=columns),
        pedestrians=frame,
    )
    return SimpleNamespace(egos=(ego,), timing_summary={"real_time_factor": 20.0})


def _shown(run):
    return {line.label: (*line.values, line.unit) for line in digest(run)}


def test_a_quiet_drive_shows_its_contacts_and_close_passes_also_as_0():
    assert list(_shown(_run(QUIET))) == [
        "Time to the goal",
        "Mean speed",
        "Stops",
        "Pedestrians touched",
        "Close passes: < 0.5 m at > 2 m/s",
        "Real-time factor",
    ]


def test_on_roads_red_lights_are_shown_also_as_0_and_speeds_are_in_km_h():
    shown = _shown(_run(RULED, ruled=True))
    assert shown["Red lights run"] == ("0", "")
    assert shown["Mean speed"] == ("18.00", "km/h")
    assert "People let pass at crossings" not in shown


def test_more_than_fits_leaves_out_what_tells_least():
    run = _run(EVENTFUL, ruled=True)
    shown = _shown(run)
    assert len(shown) == MOST
    assert {"Failures to yield", "Vehicles touched", "of these, the ego moved into"} <= set(shown)
    assert not {"Steps of the safety layer", "Hardest braking"} & set(shown)
    groups = [line.group for line in digest(run)]
    assert groups == sorted(groups, key=["drive", "people", "rules", "computing"].index)


def test_people_who_walk_as_recorded_are_told_in_words():
    columns = [SimpleNamespace(name=n, unit=None) for n in ("handed_over", "recorded_contacts")]
    quiet = QUIET | {"handed_over": 0, "recorded_contacts": 0}
    assert _shown(_run(quiet, columns=columns)) == _shown(_run(QUIET))
    met = _shown(_run(quiet | {"recorded_contacts": 2}, columns=columns))
    assert met["Overlaps with people as recorded"] == ("2", "")


def test_people_let_pass_are_counted():
    assert _shown(_run(RULED | {"encounters": 4, "yielding_rate": 0.75}, ruled=True))[
        "People let pass at crossings"
    ] == ("3 of 4", "")


@pytest.mark.parametrize(
    ("people", "moment"),
    [
        ([], ""),
        ([("a", "", 3.0, float("nan"), float("nan"))], ""),
        (
            [("a", "", 3.0, 2.0, 2.5), ("b", "", 3.0, 1.0, 4.04)],
            "b is nearest to a collision at 4.0 s",
        ),
        ([("a", "frontal", 3.0, 0.0, 2.9), ("b", "side", 2.0, 0.0, 2.0)], "a is hit near 3.0 s"),
    ],
)
def test_the_moment_to_watch_is_a_hit_or_the_nearest_to_one(people, moment):
    assert worth_watching(_run(QUIET, people=people)) == moment
