"""The top view: everybody where they were, to scale."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.image import imread
from matplotlib.patches import Polygon

from giveway.figures import crowd_view_figure, top_view_figure
from giveway.figures.road import LIGHTS
from giveway.figures.style import save_figure
from giveway.figures.top_view import VIEW, Backdrop, rectangle
from giveway.figures.view import SLENDEREST
from giveway.geometry.bodies import VehicleShape
from giveway.metrics import pedestrian_metrics
from giveway.run_data.road_marks import RoadMarks, SignalHead, Zebra
from giveway.run_data.tracks import BackgroundTrack, CrowdTrack, SignalTrack

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27


def nobody():
    none = np.empty(0)
    index = np.empty(0, dtype=np.int64)
    return CrowdTrack(index, index, none, none, none, none, ids=())


def panels(figure):
    """The overview and the snapshots; the colour bar is left out."""
    overview, *snapshots = [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]
    return overview, snapshots


def drawn(axes, kind, label):
    return next(artist for artist in axes.collections + axes.patches
                if isinstance(artist, kind) and artist.get_label() == label)  # fmt: skip


def test_the_rectangle_hangs_behind_the_front_bumper(run):
    ego, _ = run(0, 1, "mpc")
    count = ego.time.size
    turned = replace(
        ego,
        front_x=np.full(count, 10.0),
        front_y=np.full(count, 20.0),
        heading=np.full(count, pi / 2),
    )
    corners = rectangle(turned, 0, CAR)
    np.testing.assert_allclose(corners, [(9, 20), (9, 15), (11, 15), (11, 20)], atol=1e-12)


def test_snapshots_show_everybody_to_scale(run):
    ego, crowd = run(30, 1, "mpc")
    _, snapshots = panels(top_view_figure(ego, crowd, CAR, R, times=(2.0, 6.0)))
    assert [axes.get_title() for axes in snapshots] == ["1: 2.0 s", "2: 6.0 s"]
    for axes, k in zip(snapshots, (40, 120), strict=True):
        here = crowd.step == k
        circles = drawn(axes, EllipseCollection, "pedestrians")
        np.testing.assert_allclose(
            circles.get_offsets(), np.column_stack((crowd.x[here], crowd.y[here]))
        )
        np.testing.assert_allclose(circles.get_widths(), 2 * R)
        assert circles.get_offset_transform() == axes.transData
        np.testing.assert_allclose(drawn(axes, Polygon, "ego").get_xy()[:4], rectangle(ego, k, CAR))
        assert axes.get_aspect() == 1.0


def test_velocity_ticks_are_a_second_of_walking(run):
    ego, crowd = run(30, 1, "mpc")
    _, (axes,) = panels(top_view_figure(ego, crowd, CAR, R, times=[3.0]))
    here = crowd.step == 60
    (ticks,) = [c for c in axes.collections if isinstance(c, LineCollection)]
    ends = np.array([segment[1] - segment[0] for segment in ticks.get_segments()])
    np.testing.assert_allclose(ends, np.column_stack((crowd.vx[here], crowd.vy[here])))


def test_six_snapshots_show_the_encounter_and_closest_approach(run):
    ego, crowd = run(30, 1, "mpc")
    _, snapshots = panels(top_view_figure(ego, crowd, CAR, R))
    times = [float(axes.get_title().split()[1]) for axes in snapshots]
    assert len(times) == 6
    apart = np.hypot(crowd.x - ego.front_x[crowd.step], crowd.y - ego.front_y[crowd.step])
    close = ego.time[crowd.step[apart < 10.0]]
    assert close.min() - 0.05 < times[0] < close.min() + 2.0
    assert times[-1] == pytest.approx(close.max(), abs=0.051)
    assert times == sorted(times)
    (named,) = [axes for axes in snapshots if axes.get_title().endswith("closest approach")]
    clearance = pedestrian_metrics(ego, crowd, CAR, R)["minimum_clearance"].min()
    about = np.flatnonzero(np.abs(ego.time - times[snapshots.index(named)]) < 0.06)
    gaps = []
    for k in about:
        here = crowd.step == k
        x, y = np.abs(crowd.x[here] - ego.front_x[k] + 2.5), np.abs(crowd.y[here])
        gaps.append(np.hypot(np.maximum(x - 2.5, 0.0), np.maximum(y - 1.0, 0.0)).min())
    assert min(gaps) - R == pytest.approx(clearance, abs=1e-6)


def test_late_trajectories_stand_out_on_white_and_lie_on_top(run):
    ego, crowd = run(30, 1, "mpc")
    overview, _ = panels(top_view_figure(ego, crowd, CAR, R))
    lines = drawn(overview, LineCollection, "pedestrians")
    for share in np.linspace(0.0, 1.0, 11):
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
                  for c in lines.cmap(share)[:3]]  # fmt: skip
        luminance = float(np.dot((0.2126, 0.7152, 0.0722), linear))
        assert 1.05 / (luminance + 0.05) >= 3.0  # WCAG 2.2, 1.4.11
    assert (np.diff(lines.get_array()) >= 0.0).all()


def test_crossings_are_striped_and_stop_lines_coloured_by_light(run):
    ego, crowd = run(10, 2, "mpc")
    marks = RoadMarks(
        (Zebra(((30.0, -3.5), (30.0, 3.5)), 4.0), Zebra(((900.0, 0.0), (900.0, 7.0)), 4.0)),
        (SignalHead(((27.0, 0.0), (27.0, -3.5)), "j", (1,)),),
    )
    signals = SignalTrack(np.array([0.0, 2.0]), np.array(["j", "j"]), np.array(["Gr", "rG"]))
    figure = top_view_figure(
        ego, crowd, CAR, R, times=[1.0, 2.0], backdrop=Backdrop(marks=marks, signals=signals)
    )
    overview, (before, after) = panels(figure)
    for axes in (overview, before, after):
        stripes = [path.vertices for path in drawn(axes, PolyCollection, "stripes").get_paths()]
        assert len(stripes) == 7  # the crossing out of the view has none
        for stripe in stripes:  # along the way of the vehicles, within the crossing
            assert np.ptp(stripe[:, 0]) == pytest.approx(4.0)
            assert np.ptp(stripe[:, 1]) == pytest.approx(0.5)
            assert np.abs(stripe[:, 1]).max() <= 3.5
    shown = [drawn(axes, LineCollection, "lights").get_color()[0] for axes in (before, after)]
    assert [tuple(colour) for colour in shown] == [to_rgba(LIGHTS["r"]), to_rgba(LIGHTS["G"])]


def test_the_overview_has_every_trajectory_coloured_by_time(run):
    ego, crowd = run(30, 1, "mpc")
    overview, _ = panels(top_view_figure(ego, crowd, CAR, R))
    left, right = overview.get_xlim()
    bottom, top = overview.get_ylim()
    assert left < min(crowd.x.min(), ego.front_x[0] - 5.0)
    assert right > max(crowd.x.max(), ego.front_x[-1])
    assert bottom < crowd.y.min() < crowd.y.max() < top
    lines = drawn(overview, LineCollection, "pedestrians")
    ends = np.array(lines.get_segments())
    for i in range(len(crowd.ids)):
        mine = np.flatnonzero(crowd.pedestrian == i)
        for place, side in ((mine[0], 0), (mine[-1], 1)):
            assert (ends[:, side] == (crowd.x[place], crowd.y[place])).all(axis=1).any()
    assert lines.norm.vmin == ego.time[0]
    assert lines.norm.vmax == ego.time[-1]


def test_where_sumo_moved_a_person_meanwhile_no_line_is_drawn(run):
    ego, crowd = run(30, 1, "mpc")
    away = (crowd.pedestrian == 0) & (np.abs(ego.time[crowd.step] - ego.time[0] - 5.0) < 2.0)
    rest = CrowdTrack(
        *(getattr(crowd, name)[~away] for name in ("step", "pedestrian", "x", "y", "vx", "vy")),
        ids=crowd.ids,
    )

    def longest(track):
        overview, _ = panels(top_view_figure(ego, track, CAR, R))
        ends = np.array(drawn(overview, LineCollection, "pedestrians").get_segments())
        return np.hypot(*(ends[:, 1] - ends[:, 0]).T).max()

    assert away.sum() > 50
    assert longest(rest) == pytest.approx(longest(crowd), rel=0.2)


def test_the_road_lies_underneath(run):
    ego, crowd = run(5, 1, "mpc")
    area = np.array([(0.0, -2.0), (45.0, -2.0), (45.0, 2.0), (0.0, 2.0), (0.0, -2.0)])
    edge = np.array([(0.0, 0.0), (45.0, 0.0)])
    overview, snapshots = panels(
        top_view_figure(ego, crowd, CAR, R, backdrop=Backdrop([area, edge]))
    )
    for axes in (overview, *snapshots):
        filled = axes.patches[0]
        np.testing.assert_array_equal(filled.get_xy(), area)
        np.testing.assert_array_equal(axes.lines[0].get_xydata(), edge)
        assert filled.get_zorder() < axes.lines[0].get_zorder() < 1.0


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("count", [1, 2, 500])
def test_a_run_without_pedestrians_is_drawn(run, count, tmp_path):
    ego, _ = run(0, 1, "mpc")
    ego = replace(ego, **{name: column[:count] for name, column in vars(ego).items()})
    top_view_figure(ego, nobody(), CAR, R).savefig(tmp_path / "top_view.png")


@pytest.mark.filterwarnings("error")
def test_a_long_flat_run_and_single_records_are_drawn(run, tmp_path):
    ego, _ = run(0, 1, "mpc", goal=200.0)
    once = CrowdTrack(
        np.array([3, 3]), np.array([0, 2]), *np.full((4, 2), 1.0), ids=("here", "never", "there")
    )
    overview, snapshots = panels(figure := top_view_figure(ego, once, CAR, R, times=[0.15]))
    figure.savefig(tmp_path / "top_view.png")
    assert len(snapshots) == 1
    width, height = figure.get_size_inches()
    assert width < 15.0
    assert height < 15.0
    assert overview.get_position().y0 > snapshots[0].get_position().y0  # above, not beside


def test_nothing_to_draw_is_refused(run):
    ego, crowd = run(0, 1, "mpc")[0], nobody()
    with pytest.raises(ValueError, match="times is empty"):
        top_view_figure(ego, crowd, CAR, R, times=())
    empty = replace(ego, **{name: column[:0] for name, column in vars(ego).items()})
    with pytest.raises(ValueError, match="no instants"):
        top_view_figure(empty, crowd, CAR, R)


def test_other_vehicles_are_drawn_where_they_are_by_then(run):
    ego, crowd = run(10, 2, "mpc")
    one = np.ones(1)
    car = BackgroundTrack(
        time=one * 0.0,
        id=np.array(["c"]),
        type=np.array(["car"]),
        x=one * 30.0,
        y=one * 4.0,
        heading=one * 0.0,
        speed=one * 2.0,
        length=one * 4.0,
        width=one * 2.0,
    )
    figure = top_view_figure(
        ego, crowd, VehicleShape(), 0.27, times=[0.0, 1.0], backdrop=Backdrop(background=car)
    )
    (at_0,), (at_1,) = (
        [patch for patch in axes.patches if patch.get_label() == "background"]
        for axes in figure.axes
        if axes.get_title()[:1].isdigit()
    )
    assert at_0.get_xy()[:4].tolist() == [[30, 5], [26, 5], [26, 3], [30, 3]]
    assert at_1.get_xy()[:4].tolist() == [[32, 5], [28, 5], [28, 3], [32, 3]]


def test_on_a_long_drive_the_snapshots_go_along_with_the_ego(run):
    ego, _ = run(0, 1, "mpc", 400.0)
    figure = top_view_figure(ego, nobody(), CAR, R)
    overview, snapshots = panels(figure)
    for axes in snapshots:
        assert np.diff(axes.get_xlim())[0] == pytest.approx(VIEW[0])
        assert np.diff(axes.get_ylim())[0] == pytest.approx(VIEW[1])
        car = drawn(axes, Polygon, "ego").get_xy()[:-1].mean(axis=0)
        np.testing.assert_allclose(car, (np.mean(axes.get_xlim()), np.mean(axes.get_ylim())))
    height, width = np.diff(overview.get_ylim())[0], np.diff(overview.get_xlim())[0]
    assert height / width == pytest.approx(0.5 / SLENDEREST)  # not a mere line


def test_roads_out_of_the_view_are_not_drawn(run):
    ego, crowd = run(5, 1, "mpc")
    near = np.array([(0, -2), (50, -2), (50, 2), (0, 2), (0, -2)], dtype=float)
    figure = top_view_figure(ego, crowd, CAR, R, backdrop=Backdrop([near, near + 1000.0]))
    overview, _ = panels(figure)
    roads = [patch for patch in overview.patches if len(patch.get_xy()) == len(near)]
    assert sum(np.array_equal(road.get_xy(), near) for road in roads) == 1
    assert not any(np.array_equal(road.get_xy(), near + 1000.0) for road in roads)


def test_without_an_ego_the_walks_are_drawn(run):
    ego, crowd = run(7, 1, "mpc")
    axes, _ = panels(crowd_view_figure(ego.time, crowd, title="seven"))
    lines = drawn(axes, LineCollection, "pedestrians")
    assert len(lines.get_segments()) > 7
    assert lines.get_array().max() <= ego.time[-1]
    with pytest.raises(ValueError, match="nobody was recorded"):
        crowd_view_figure(ego.time, nobody())


def test_no_label_is_cut_beside_the_snapshots(run, tmp_path):
    ego, _ = run(0, 1, "mpc", 28.0)
    step = np.repeat(np.arange(ego.time.size), 5)
    x = np.tile(12.0 + 8.0 * np.arange(5), ego.time.size)
    y = 37.0 * ego.time[step] / ego.time[-1] - 18.5
    still = np.zeros(x.size)
    who = np.tile(np.arange(5), ego.time.size)
    crowd = CrowdTrack(step, who, x, y, still, still + 3.0, ids=tuple("abcde"))
    save_figure(top_view_figure(ego, crowd, CAR, R, title="Run"), tmp_path / "run.png")
    assert imread(tmp_path / "run.png")[-2:, :, :3].min() > 0.99
