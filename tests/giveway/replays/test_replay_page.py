"""The page plays the run: what is drawn is what the tables say, and hands move it."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

DRIVING, STANDING = 4.0, 6.9  # [s] under the MPC; under the PID


@pytest.fixture(scope="module")
def ego(recorded: Path) -> pd.DataFrame:
    return pd.read_csv(recorded / "ego.csv", dtype={"id": str})


def at(ego: pd.DataFrame, time: float) -> Any:
    return ego.iloc[(ego["time"] - time).abs().argmin()]


def tail(row: Any) -> tuple[float, float]:
    """A place on the ego's body, away from the arrow on its front [m]."""
    heading = np.radians(90.0 - row["angle"])
    return row["x"] - 3.5 * np.cos(heading), row["y"] - 3.5 * np.sin(heading)


@pytest.mark.parametrize("time", [1.0, DRIVING, STANDING])
def test_the_ego_is_where_its_row_says_in_its_drivers_colour(
    watched: Any, ego: pd.DataFrame, time: float
) -> None:
    watched.seek(time)
    row = at(ego, time)
    assert watched.pixel(*watched.place(*tail(row))) == watched.colour(row["controller"])
    assert watched.tab.inner_text("#badge") == row["controller"].upper()


def test_it_moves_by_as_many_pixels_as_metres_and_scale_tell(
    watched: Any, ego: pd.DataFrame
) -> None:
    rear = []
    for time in (1.0, 2.0):
        watched.seek(time)
        row = at(ego, time)
        x, y = watched.place(*tail(row))
        ours = watched.columns(watched.colour("mpc"), y, "stage")
        assert min(ours) < x < max(ours)
        rear.append(min(ours))
    driven = at(ego, 2.0)["x"] - at(ego, 1.0)["x"]
    assert rear[1] - rear[0] == pytest.approx(
        driven * watched.tab.evaluate("replay.scale"), abs=1.5
    )


def test_pedestrians_stand_at_their_places(watched: Any, recorded: Path) -> None:
    rows = pd.read_csv(recorded / "trajectories.csv", dtype={"id": str})
    people = rows[(rows["type"] == "pedestrian") & np.isclose(rows["time"], 3.0)]
    for layer in ("influence", "predictions"):
        watched.tab.uncheck(f"[data-layer={layer}]")
    watched.seek(3.0)
    bodies = {watched.colour(name) for name in ("person", "close", "inside")}
    behind = np.radians(90.0 - people["angle"].to_numpy())  # away from the tick
    x = people["x"] - 0.15 * np.cos(behind)
    y = people["y"] - 0.15 * np.sin(behind)
    seen = [watched.pixel(*watched.place(*place)) in bodies for place in zip(x, y, strict=True)]
    assert len(seen) == 30
    assert all(seen)


@pytest.mark.parametrize("layer", ["influence", "prediction"])
def test_a_layer_appears_and_disappears_with_its_switch(watched: Any, layer: str) -> None:
    watched.tab.keyboard.press("f")  # close by
    watched.seek(5.2)
    box = {"influence": "influence", "prediction": "predictions"}[layer]
    colour = watched.colour(layer)
    with_it = watched.count(colour)
    watched.tab.uncheck(f"[data-layer={box}]")
    watched.settle()
    assert with_it > 20
    assert watched.count(colour) == 0


def test_predictions_are_drawn_where_they_were_recorded(watched: Any, recorded: Path) -> None:
    rows = pd.read_csv(recorded / "predictions.csv", dtype={"id": str})
    time = rows["time"].iloc[0]
    nearest = rows[(rows["time"] == time) & (rows["look_ahead"] == 0.75)]
    for layer in ("people", "influence", "corridor", "road"):
        watched.tab.uncheck(f"[data-layer={layer}]")
    watched.seek(time)
    ground = watched.colour("ground")
    places = zip(nearest["x"], nearest["y"], strict=True)
    drawn = [watched.pixel(*watched.place(*place)) != ground for place in places]
    assert np.mean(drawn) == 1.0
    watched.seek(time - 0.1)  # none had been made by then
    assert watched.count(watched.colour("prediction")) == 0


def test_keys_move_time(watched: Any, ego: pd.DataFrame) -> None:
    instants = ego["time"].to_numpy()
    press = watched.tab.keyboard.press
    press("End")
    assert watched.time == pytest.approx(instants[-1])
    press("ArrowLeft")
    assert watched.time == pytest.approx(instants[-2])
    press("Shift+ArrowLeft")
    assert watched.time == pytest.approx(instants[-2] - 1.0)
    press("Home")
    assert watched.time == pytest.approx(instants[0])
    press("ArrowRight")
    assert watched.time == pytest.approx(instants[1])
    before = watched.time
    press("ArrowUp")
    assert watched.tab.input_value("#speed") == "2"
    press(" ")
    for _ in range(100):  # a browser on a busy machine draws when it can
        watched.tab.wait_for_timeout(50)
        if watched.time > before + 0.2:
            break
    press(" ")
    stopped = watched.time
    assert stopped > before + 0.2
    watched.tab.wait_for_timeout(100)
    assert watched.time == stopped


def test_the_scrubber_and_the_charts_move_time(watched: Any) -> None:
    scrubber = watched.tab.locator("#scrubber").bounding_box()
    middle = scrubber["x"] + scrubber["width"] / 2
    watched.tab.mouse.click(middle, scrubber["y"] + scrubber["height"] / 2)
    assert watched.time == pytest.approx(3.5, abs=0.1)
    charts = watched.tab.locator("#charts").bounding_box()
    watched.tab.mouse.click(charts["x"] + 46, charts["y"] + 60)
    assert watched.time == pytest.approx(0.0, abs=0.02)


def test_the_charts_cursor_is_at_the_time(watched: Any) -> None:
    box = watched.tab.locator("#charts").bounding_box()
    columns = []
    for time in (1.75, 5.25):
        watched.seek(time)
        dark = watched.columns(watched.colour("ink"), 4.0, "charts")  # its round head
        assert max(dark) - min(dark) < 10
        columns.append(float(np.mean(dark)))
    plot = box["width"] - 46 - 14
    assert columns == pytest.approx([46 + plot / 4, 46 + 3 * plot / 4], abs=2.0)


def test_the_address_points_at_an_instant(watch: Callable[..., Any], page: Path) -> None:
    watched = watch(page, at="#t=3.2")
    assert watched.time == pytest.approx(3.2)
    watched.seek(4.4)
    watched.seek(4.5)
    watched.until("location.hash === '#t=4.5'")
    watched.tab.evaluate("location.hash = '#t=2'")
    watched.until("replay.time === 2")


@pytest.mark.parametrize("address", ["#t=3.2.1", "#t=x", "#t=", "#t=-9"])
def test_an_address_that_is_no_instant_opens_the_beginning(
    watch: Callable[..., Any], page: Path, address: str
) -> None:
    assert watch(page, at=address).time == 0.0


def test_the_address_can_follow_the_ego(
    watch: Callable[..., Any], page: Path, ego: pd.DataFrame
) -> None:
    watched = watch(page, at="#t=3.2&follow")
    box = watched.tab.locator("#stage").bounding_box()
    x, y = watched.place(*at(ego, 3.2)[["x", "y"]])
    lead = 3.0 * watched.tab.evaluate("replay.scale")
    assert (x, y) == pytest.approx((box["width"] / 2 - lead, box["height"] / 2), abs=1.0)
    watched.seek(4.0)
    watched.until("location.hash === '#t=4&follow'")


def test_a_resized_window_shows_the_same_unless_moved_by_hand(
    watch: Callable[..., Any], page: Path
) -> None:
    watched = watch(page)
    whole = watched.tab.evaluate("EXTENT.map((x, i) => x + RUN.origin[i % 2])")
    for size in ((700, 900), (1500, 700)):
        watched.tab.set_viewport_size(dict(zip(("width", "height"), size, strict=True)))
        watched.settle()
        box = watched.tab.locator("#stage").bounding_box()
        left, bottom = watched.place(*whole[:2])
        right, top = watched.place(*whole[2:])
        margins = min(left, box["width"] - right), min(top, box["height"] - bottom)
        assert min(margins) == pytest.approx(0.0, abs=1.0)
    watched.tab.keyboard.press("+")
    scale = watched.tab.evaluate("replay.scale")
    watched.tab.set_viewport_size({"width": 900, "height": 900})
    watched.settle()
    assert watched.tab.evaluate("replay.scale") == scale


def test_wheel_keys_and_drag_change_the_view_follow_keeps_ego(
    watched: Any, ego: pd.DataFrame
) -> None:
    scale = watched.tab.evaluate("replay.scale")
    box = watched.tab.locator("#stage").bounding_box()
    x, y = box["x"] + 300, box["y"] + 200
    watched.tab.mouse.move(x, y)
    watched.tab.mouse.wheel(0, -200)
    watched.until(f"replay.scale > {1.2 * scale}")
    watched.tab.keyboard.press("-")
    before = watched.place(20.0, 0.0)
    watched.tab.mouse.down()
    watched.tab.mouse.move(x + 50, y + 30, steps=3)
    watched.tab.mouse.up()
    after = watched.place(20.0, 0.0)
    assert np.subtract(after, before) == pytest.approx([50.0, 30.0], abs=0.5)
    watched.tab.keyboard.press("f")
    middles = []
    for time in (1.0, STANDING):
        watched.seek(time)
        middles.append(watched.place(*at(ego, time)[["x", "y"]]))
    assert middles[0] == pytest.approx(middles[1], abs=1.0)


def test_a_click_on_a_pedestrian_tells_who_it_is(watched: Any, recorded: Path) -> None:
    rows = pd.read_csv(recorded / "trajectories.csv", dtype={"id": str})
    now = rows[(rows["type"] == "pedestrian") & np.isclose(rows["time"], 3.0)]
    loneliest = now.assign(
        apart=[np.sort(np.hypot(now["x"] - row.x, now["y"] - row.y))[1] for row in now.itertuples()]
    ).nlargest(1, "apart")
    person = loneliest.iloc[0]
    watched.seek(3.0)
    box = watched.tab.locator("#stage").bounding_box()
    x, y = watched.place(person["x"], person["y"])
    watched.tab.mouse.click(box["x"] + x, box["y"] + y)
    watched.settle()
    assert watched.tab.inner_text("#person-id") == person["id"]
    speed = float(watched.tab.inner_text("#person-speed").split()[0])
    assert speed == pytest.approx(person["speed"], abs=0.011)


def test_time_to_collision_and_distance_are_those_of_the_metrics(
    watched: Any, recorded: Path
) -> None:
    people = pd.read_csv(recorded / "pedestrians.csv", dtype={"id": str})
    for what, minimum in (("clearance", "minimum_clearance"), ("timeToCollision", "minimum_ttc")):
        row = people.loc[people[minimum].idxmin()]
        measure = f"""([name, t]) => {{
          const who = PEOPLE.names.indexOf(name);
          let found = null;
          PEOPLE.each(t, (at) => {{ if (at.who === who) found = {{...at}}; }});
          const state = EGOS[0].at(t);
          return {what} === clearance ? clearance(EGOS[0], state, found.x, found.y)
            : timeToCollision(EGOS[0], state, found);
        }}"""
        value = watched.tab.evaluate(measure, [row["id"], row[f"time_of_{minimum}"]])
        assert value == pytest.approx(row[minimum], abs=0.02)


def test_an_event_leads_to_its_instant(watched: Any, ego: pd.DataFrame) -> None:
    acting = ego["controller"].to_numpy()
    first = next(i + 1 for i, (a, b) in enumerate(pairwise(acting)) if (a, b) == ("mpc", "pid"))
    watched.tab.locator("#events button", has_text="PID").first.click()
    watched.settle()
    assert watched.time == pytest.approx(ego["time"].iloc[first])
    assert "no solution" in watched.tab.inner_text(".wheel")


def test_the_closest_approach_leads_to_whom_it_was(watched: Any, recorded: Path) -> None:
    people = pd.read_csv(recorded / "pedestrians.csv", dtype={"id": str})
    closest = people.loc[people["minimum_clearance"].idxmin()]
    watched.tab.locator("#events button", has_text=closest["id"]).first.click()
    watched.settle()
    assert watched.tab.inner_text("#person-id") == closest["id"]
    distance = float(watched.tab.inner_text("#person-distance").split()[0].replace("−", "-"))
    assert distance == pytest.approx(closest["minimum_clearance"], abs=0.011)


def test_it_complains_about_nothing_and_asks_nobody(watched: Any) -> None:
    watched.tab.keyboard.press(" ")
    watched.tab.wait_for_timeout(200)
    watched.tab.keyboard.press("?")
    assert watched.tab.locator("#help").is_visible()
    watched.tab.keyboard.press("Escape")
    assert watched.complaints == []
    assert watched.requests == []


def test_slider_and_charts_tell_what_they_show_in_words(watched: Any, ego: pd.DataFrame) -> None:
    watched.seek(DRIVING)
    words = watched.tab.get_attribute("#scrubber", "aria-valuetext")
    speed = at(ego, DRIVING)["speed"]
    assert words == f"4.00 s of 7.00 s, {speed:.1f} m/s, MPC acts"
    gap = watched.tab.get_attribute("#charts", "aria-label")
    least = ego["gap"].replace(np.inf, np.nan).min()
    assert f"gap to the closest person in front: {least:.2f} m at least" in gap
    assert f"{ego['speed'].max():.2f} m/s at most" in gap


def test_the_lower_chart_shows_what_is_chosen(watched: Any, recorded: Path) -> None:
    people = pd.read_csv(recorded / "pedestrians.csv", dtype={"id": str})
    watched.tab.select_option("#below", "ttc")
    watched.settle()
    least = min(watched.tab.evaluate("Array.from(EGOS[0].ttc)"))
    assert least == pytest.approx(people["minimum_ttc"].min(), abs=0.05)
    assert f"{least:.2f} s at least" in watched.tab.get_attribute("#charts", "aria-label")
    assert watched.tab.locator("#key-ttc").is_visible()
    assert not watched.tab.locator("#key-gap").is_visible()
    watched.tab.select_option("#below", "force")
    assert "force" in watched.tab.get_attribute("#charts", "aria-label")


def test_trails_are_drawn_along_the_last_seconds_alone(watched: Any, ego: pd.DataFrame) -> None:
    for layer in ("influence", "predictions", "corridor", "people"):
        watched.tab.uncheck(f"[data-layer={layer}]")
    watched.seek(6.0)
    front = watched.place(*at(ego, 6.0)[["x", "y"]])
    driven = watched.columns(watched.colour("road"), front[1], "stage")
    watched.tab.check("[data-layer=trails]")
    watched.settle()
    still = watched.columns(watched.colour("road"), front[1], "stage")
    covered = sorted(set(driven) - set(still))
    begin = watched.place(*at(ego, 1.0)[["x", "y"]])[0]
    assert covered[0] == pytest.approx(begin, abs=4.0)
    assert len(covered) > 50
