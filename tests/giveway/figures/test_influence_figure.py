"""The influence figure: it draws the model that it is given."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.figures import influence_figure
from pedestrian_model import SIM, Vehicles, vehicle_influence


def vci(points, speed):
    vehicle = Vehicles.create(0.0, 0.0, 0.0, speed)
    return vehicle_influence(points, np.zeros_like(points), vehicle, SIM)[0]


def panels(figure):
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def quiver(axes):
    return next(c for c in axes.collections if hasattr(c, "U"))


def test_a_panel_per_speed_on_the_same_scale():
    figure = influence_figure(vci)
    axes = panels(figure)
    assert [one.get_title() for one in axes] == ["0 m/s", "1 m/s", "2 m/s", "4 m/s"]
    assert len({one.get_xlim() for one in axes}) == 1
    assert all(one.get_aspect() == 1.0 for one in axes)
    (bar,) = [one for one in figure.axes if one.get_label() == "<colorbar>"]
    assert bar.get_ylabel() == "Magnitude [N]"


def test_the_coordinates_are_the_vehicles_own():
    above, below = panels(influence_figure(vci, speeds=(1.0, 2.0, 4.0)))[::2]
    assert above.get_ylabel() == "to its left [m]"
    assert below.get_xlabel() == "ahead of its centre [m]"
    left, right = above.get_xlim()
    assert left < 0.0 < right
    assert sum(above.get_ylim()) == pytest.approx(0.0)  # as much to the left as to the right
    (body,) = above.patches[:1]
    assert (body.get_x(), body.get_y()) == (-2.5, -1.0)


def test_arrows_point_where_the_model_pushes():
    (axes,) = panels(influence_figure(vci, speeds=[4.0]))
    arrows = quiver(axes)
    force = vci(np.column_stack((arrows.X, arrows.Y)), 4.0)
    magnitude = np.linalg.norm(force, axis=1)
    shown = np.column_stack((arrows.U, arrows.V))
    np.testing.assert_allclose(np.linalg.norm(shown, axis=1), np.minimum(magnitude, 400.0))
    np.testing.assert_allclose(
        np.sum(shown * force, axis=1), magnitude * np.minimum(magnitude, 400.0)
    )
    inside = (np.abs(arrows.X) < 2.5) & (np.abs(arrows.Y) < 1.0)
    assert not inside.any()


def test_the_influence_expands_with_the_speed():
    slow, fast = panels(influence_figure(vci, speeds=(0.0, 4.0)))
    assert quiver(fast).X.max() > quiver(slow).X.max() + 4.0


def test_the_whole_influence_is_in_view():
    (axes,) = panels(influence_figure(vci, speeds=[4.0]))
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    x, y = np.linspace(left, right, 200), np.linspace(bottom, top, 200)
    frame = np.concatenate(
        [np.column_stack((x, np.full(200, edge))) for edge in (bottom, top)]
        + [np.column_stack((np.full(200, edge), y)) for edge in (left, right)]
    )
    assert np.linalg.norm(vci(frame, 4.0), axis=1).max() < 3.0  # [N]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("speeds", [(0.0,), (0.0, 1.0, 2.0), (-2.0, 10.0)])
def test_any_number_of_speeds_is_drawn(speeds, tmp_path):
    figure = influence_figure(vci, speeds=speeds)
    figure.savefig(tmp_path / "influence.png")
    assert len(panels(figure)) == len(speeds)


@pytest.mark.filterwarnings("error")
def test_a_model_without_any_influence_is_drawn(tmp_path):
    figure = influence_figure(lambda points, speed: np.zeros_like(points), speeds=[1.0])
    figure.savefig(tmp_path / "influence.png")


def test_no_speed_is_refused():
    with pytest.raises(ValueError, match="speeds is empty"):
        influence_figure(vci, speeds=())
