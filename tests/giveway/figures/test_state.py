"""The state figure: what is drawn, and that the phases are shaded where they were."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from giveway.figures import state_figure
from giveway.figures.state import FASTEST_WALK, SHADES, WAITS, phases, strokes

DISTANCES = {"safe_distance": 8.0, "buffer_distance": 10.0}


def first(ego, count):
    """The first instants of a track."""
    return replace(ego, **{name: column[:count] for name, column in vars(ego).items()})


def line(axes, label):
    return next(line for line in axes.lines if line.get_label() == label)


def spans(axes):
    """The shaded spans of a panel: who acted, from when, to when."""
    return [
        (patch.get_label(), patch.get_x(), patch.get_x() + patch.get_width())
        for patch in axes.patches
    ]


def test_the_three_quantities_are_drawn_with_their_units(run):
    ego, _ = run(30, 1, "mpc")
    figure = state_figure(ego, **DISTANCES, title="a title")
    speed, gap, force = figure.axes
    assert figure.get_suptitle() == "a title"
    assert speed.get_ylabel() == "Speed [m/s]"
    assert gap.get_ylabel() == "Gap to closest pedestrian\nin front [m]"
    assert force.get_ylabel() == "Force [kN]"
    assert force.get_xlabel() == "Time [s]"
    np.testing.assert_array_equal(line(speed, "speed").get_ydata(), ego.speed)
    np.testing.assert_array_equal(line(speed, "reference speed").get_ydata(), ego.reference_speed)
    np.testing.assert_array_equal(line(force, "force").get_ydata(), ego.force / 1000.0)
    drawn = line(gap, "gap").get_xydata()
    seen = np.isfinite(ego.gap)
    np.testing.assert_array_equal(
        drawn[np.isfinite(drawn[:, 1])], np.column_stack((ego.time, ego.gap))[seen]
    )
    assert line(gap, "d_safe").get_ydata() == [8.0, 8.0]
    assert line(gap, "d_safe + d_buffer").get_ydata() == [18.0, 18.0]


def test_a_controller_without_a_buffer_has_no_line_for_it(run):
    ego, _ = run(30, 1, "mpc")
    _, gap, _ = state_figure(ego, safe_distance=8.0, buffer_distance=0.0).axes
    assert line(gap, "d_safe").get_ydata() == [8.0, 8.0]
    assert "d_safe + d_buffer" not in [one.get_label() for one in gap.lines]
    assert [text.get_text().splitlines()[0] for text in gap.texts] == ["$d_{safe}$"]


def test_every_panel_is_shaded_where_each_controller_acted(run):
    ego, _ = run(30, 1, "mpc")
    assert {"mpc", "pid"} == set(ego.controller)
    for axes in state_figure(ego, **DISTANCES).axes:
        shaded = spans(axes)
        assert shaded[0][1] == ego.time[0]
        assert shaded[-1][2] == pytest.approx(ego.time[-1])
        for k in range(ego.time.size - 1):
            middle = (ego.time[k] + ego.time[k + 1]) / 2
            (acting,) = [name for name, start, end in shaded if start < middle < end]
            assert acting == ego.controller[k]
        for patch in axes.patches:
            assert patch.get_facecolor()[:3] == to_rgb(SHADES[patch.get_label()][0])


@pytest.mark.parametrize(
    ("acting", "expected"),
    [
        ("mmmm", [("mpc", 0.0, 3.0)]),
        ("pppp", [("pid", 0.0, 3.0)]),
        ("mppm", [("mpc", 0.0, 1.0), ("pid", 1.0, 3.0)]),  # the last command is not carried out
        ("mpmm", [("mpc", 0.0, 1.0), ("pid", 1.0, 2.0), ("mpc", 2.0, 3.0)]),
        ("psp", [("pid", 0.0, 1.0), ("safety", 1.0, 2.0)]),
        ("p", [("pid", -0.5, 0.5)]),  # one instant fills the picture
    ],
)
def test_phases(run, acting, expected):
    ego = first(run(0, 1, "pid")[0], len(acting))
    names = np.array([{"m": "mpc", "p": "pid", "s": "safety"}[letter] for letter in acting])
    assert phases(replace(ego, time=np.arange(float(len(acting))), controller=names)) == expected


def test_the_legend_names_who_acted_and_nobody_else(run):
    mpc, pid = run(30, 1, "mpc")[0], run(30, 1, "pid")[0]

    def legend(runs):
        (legend,) = state_figure(runs, **DISTANCES).legends
        return {text.get_text() for text in legend.get_texts()}

    curves = {"speed", "reference speed", "gap", "force"}
    assert legend(mpc) == curves | {"MPC acts", "PID acts"}
    assert legend(pid) == curves | {"PID acts"}
    guarded = pid.controller.astype("U6")
    guarded[5:9] = "safety"
    assert legend(replace(pid, controller=guarded)) == curves | {"PID acts", "safety layer acts"}


def test_runs_side_by_side_share_their_scales(run):
    pair = [("MPC", run(30, 1, "mpc")[0]), ("PID", run(30, 1, "pid")[0])]
    figure = state_figure(pair, **DISTANCES)
    grid = np.array(figure.axes).reshape(3, 2)
    assert [axes.get_title() for axes in grid[0]] == ["MPC", "PID"]
    for left, right in grid:
        assert left.get_ylim() == right.get_ylim()
        assert left.get_xlim() == right.get_xlim()
    lowest, highest = grid[2, 0].get_ylim()
    for _, ego in pair:
        assert lowest < ego.force.min() / 1000.0
        assert ego.force.max() / 1000.0 < highest


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("count", [1, 2])
def test_the_shortest_runs_are_drawn(run, count, tmp_path):
    ego = first(run(5, 1, "mpc")[0], count)
    state_figure(ego, **DISTANCES).savefig(tmp_path / "state.png")


@pytest.mark.filterwarnings("error")
def test_nobody_in_front_is_said(run, tmp_path):
    ego, _ = run(0, 1, "mpc")
    figure = state_figure(ego, **DISTANCES)
    figure.savefig(tmp_path / "state.png")
    assert "nobody in front" in [text.get_text() for text in figure.axes[1].texts]


@pytest.mark.filterwarnings("error")
def test_somebody_in_front_for_one_instant_is_a_point(run):
    ego, _ = run(0, 1, "mpc")
    gap = np.full(ego.time.size, np.inf)
    gap[10] = 5.0
    points = state_figure(replace(ego, gap=gap), **DISTANCES).axes[1].lines[-1]
    np.testing.assert_array_equal(points.get_xydata(), [(ego.time[10], 5.0)])


@pytest.mark.parametrize("nothing", [[], "a run without instants"])
def test_nothing_to_draw_is_refused(run, nothing):
    runs = nothing or []
    if nothing:
        runs = first(run(0, 1, "mpc")[0], 0)
    with pytest.raises(ValueError, match="no instants"):
        state_figure(runs, **DISTANCES)


def standing(run, **columns):
    """Two seconds of an ego that stands, with other columns than those of the drive."""
    ego = first(run(0, 1, "mpc")[0], 41)
    return replace(ego, position=np.zeros(41), speed=np.zeros(41), **columns)


def test_no_stroke_joins_the_gaps_of_different_people(run):
    gap = np.full(41, 5.0)
    gap[20:] = 9.0  # somebody else is in front from here on
    ego = standing(run, gap=gap)
    time, drawn = strokes(ego, ego.gap, FASTEST_WALK)
    (cut,) = np.flatnonzero(np.isnan(drawn))
    assert (drawn[cut - 1], drawn[cut + 1]) == (5.0, 9.0)
    assert (time[cut - 1], time[cut + 1]) == (ego.time[19], ego.time[20])
    panel = line(state_figure(ego, **DISTANCES).axes[1], "gap").get_ydata()
    np.testing.assert_array_equal(panel, drawn)


def test_a_gap_that_the_ego_closes_is_one_stroke(run):
    ego = first(run(0, 1, "mpc")[0], 41)
    toward = 30.0 - ego.position - 1.4 * (ego.time - ego.time[0])
    assert not np.isnan(strokes(ego, toward, FASTEST_WALK)[1]).any()


def test_distances_to_vehicles_and_stops_have_their_own_panel(run):
    ego = standing(run, vehicle_gap=np.full(41, 12.0), stop_gap=np.full(41, -0.2))
    figure = state_figure(ego, **DISTANCES, stop_lines=[0.7])
    _, gap, distance, _ = figure.axes
    assert distance.get_ylabel() == "Distance\nalong the way [m]"
    assert not {"to a vehicle", "to its next stop"} & {one.get_label() for one in gap.lines}
    assert set(line(distance, "to a vehicle").get_ydata()) == {12.0}
    assert set(line(distance, "to a stop line").get_ydata()) == {0.7}
    assert distance.get_ylim()[0] < -0.2  # who stands at the line is seen
    assert line(distance, "to its next stop").get_ydata()[0] == -0.2
    assert len(state_figure(standing(run), **DISTANCES).axes) == 3


def test_a_stop_line_is_drawn_until_the_ego_is_over_it(run):
    ego, _ = run(0, 1, "mpc")
    panel = state_figure(ego, **DISTANCES, stop_lines=[10.0]).axes[2]
    left = line(panel, "to a stop line").get_ydata()
    np.testing.assert_allclose(left[ego.position < 10.0], 10.0 - ego.position[ego.position < 10.0])
    assert np.isnan(left[ego.position > 10.6]).all()


def test_bars_say_what_the_ego_stands_for(run):
    cause = np.array([""] * 10 + ["light"] * 10 + ["yield"] * 21)
    ego = standing(run, waits_for=cause)
    figure = state_figure(ego, **DISTANCES)
    speed = figure.axes[0]
    assert list(line(speed, "light").get_xdata()) == [ego.time[10], ego.time[20]]
    assert list(line(speed, "yield").get_xdata()) == [ego.time[20], ego.time[40]]
    assert to_rgb(line(speed, "yield").get_color()) == to_rgb(WAITS["yield"][0])
    named = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {"stands at a red light", "stands to yield"} <= named
    assert "stands for a person" not in named
