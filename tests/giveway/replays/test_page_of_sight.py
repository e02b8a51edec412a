"""Page, film and top view of a drive with cameras: shadows, and who is not perceived."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely
from matplotlib.collections import EllipseCollection
from matplotlib.colors import to_hex
from matplotlib.patches import PathPatch

import giveway
from giveway.exports.film import Painter
from giveway.exports.sampling import sampled
from giveway.figures.sight_view import SightView
from giveway.figures.style import VERMILION
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from giveway.replays import write_replay
from giveway.replays.run_folder import RunFolder
from giveway.results.pictures import top_view_picture

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from giveway import RunResult

HIDDEN, SEEN = 13.0, 14.35  # s: the child between the cars; perceived


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> tuple[RunResult, RunFolder]:
    folder = tmp_path_factory.mktemp("drive")
    settings = {"scenario": "parked_cars", "time_limit": 12.4, "sumo.baseline": False}
    return giveway.run(settings, results=folder, pictures=False), RunFolder.read(folder)


def shadow(run: RunFolder, time: float) -> Any:
    """The area that no camera sees."""
    rows = run.trajectories[(run.trajectories["time"] - time).abs() < 1e-6]
    ego = rows[rows["type"] == "ego"].iloc[0]
    cars = run.trajectories[run.trajectories["type"] == "parked"].drop_duplicates("id")
    shape = VehicleShape(4.5, 1.8)
    others = [(car.id, shape.corners(np.array([car.x, car.y]), 0.0)) for car in cars.itertuples()]
    view = SightView.of(run.egos["ego"], run.sights, run.scene.opaque)
    return view.hidden(Pose(ego.x, ego.y, 0.0), others)


def test_the_page_has_the_shadows_of_the_sensor(
    drive: tuple[RunResult, RunFolder], watch: Callable[..., Any], tmp_path: Path
) -> None:
    run = drive[1]
    watched = watch(write_replay(run.path, tmp_path / "page.html"))
    watched.seek(HIDDEN)
    assert watched.tab.evaluate("unseen(0, 13.0) && !unseen(0, 14.35)")
    assert "sight" in watched.tab.evaluate("EGOS[0].events.map(e => e.kind)")
    area = shadow(run, HIDDEN)
    points = np.random.default_rng(1).uniform((60.0, -9.0), (90.0, 6.0), (300, 2))
    points = points[shapely.distance(area.boundary, shapely.points(points)) > 0.2]
    told = watched.tab.evaluate(
        """points => {
            const { width, height } = hiddenLayer.canvas;
            const { data } = hiddenLayer.getImageData(0, 0, width, height);
            return points.map(([x, y]) => {
                const [px, py] = replay.place(x, y).map(at => Math.round(at * view.ratio));
                return data[4 * (py * width + px) + 3] > 128;
            });
        }""",
        points.tolist(),
    )
    inside = [watched.place(x, y) for x, y in points]
    width, height = watched.tab.evaluate("[view.width, view.height]")
    shown = np.array([0 < x < width and 0 < y < height for x, y in inside])
    assert shown.sum() > 100
    assert (np.array(told) == shapely.contains_xy(area, *points.T))[shown].all()
    assert watched.complaints == []


def test_films_darken_shadows(drive: tuple[RunResult, RunFolder]) -> None:
    run = drive[1]
    samples = sampled(run, 0.5)
    painter = Painter(run, samples, (640, 360))
    index = round((HIDDEN - samples.begin) / 0.5)
    view = painter._view(index)
    frame = painter._ground(view)
    before = frame.copy()
    painter._paint(frame, index, view)
    area = shadow(run, HIDDEN)
    for place in ((80.0, -8.0), (80.0, 2.0)):
        ((x, y),) = painter._pixels(np.array([place]), view)
        at = round(x), round(y)
        darker = frame.getpixel(at)[0] < before.getpixel(at)[0]
        assert darker == area.contains(shapely.Point(place))


def test_top_views_have_shadows_and_hollow_people(drive: tuple[RunResult, RunFolder]) -> None:
    result = drive[0]
    figure = top_view_picture(result, result.egos[0])
    snapshots = [axes for axes in figure.axes if axes.get_title()[:1].isdigit()]
    assert all(any(isinstance(p, PathPatch) for p in axes.patches) for axes in snapshots)
    fills = []
    for axes in snapshots:
        people = next(c for c in axes.collections if isinstance(c, EllipseCollection))
        fills += [to_hex(colour, keep_alpha=True) for colour in people.get_facecolors()]
    assert "#00000000" in fills
    assert to_hex(VERMILION, keep_alpha=True) in fills


def test_trajectories_tell_who_is_perceived(drive: tuple[RunResult, RunFolder]) -> None:
    rows = drive[1].trajectories
    child = rows[rows["type"] == "pedestrian"].set_index("time")["seen"]
    assert [bool(child[time]) for time in (HIDDEN, SEEN)] == [False, True]
    assert rows.loc[rows["type"] != "pedestrian", "seen"].isna().all()
