"""An ego whose lanes say how fast it drives keeps their limits, and slows down before they fall."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

TAKEN = '<vType id="t" maxSpeed="12"/><trip id="car" type="t" depart="0" from="ab" to="cd"/>'


@pytest.fixture(scope="module")
def bent(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """A road of 13.9 m/s, then one of 8.3 m/s, then a right-angled bend to one of 11 m/s."""
    folder = tmp_path_factory.mktemp("bent")
    (folder / "n.nod.xml").write_text(
        '<nodes><node id="a" x="0" y="0"/><node id="b" x="110" y="0"/>'
        '<node id="c" x="170" y="0"/><node id="d" x="170" y="60"/></nodes>'
    )
    (folder / "e.edg.xml").write_text(
        '<edges><edge id="ab" from="a" to="b" speed="13.9"/>'
        '<edge id="bc" from="b" to="c" speed="8.3"/><edge id="cd" from="c" to="d" speed="11"/>'
        "</edges>"
    )
    net = folder / "bent.net.xml"
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=folder)
    return net


def limits_along(net: Path, x: Any, y: Any) -> Any:
    """(T,) [m/s] of the lane at each place; where two meet, the higher one."""
    lanes = list(ElementTree.parse(net).iter("lane"))
    shapes = [
        shapely.LineString([tuple(map(float, p.split(","))) for p in lane.get("shape").split()])
        for lane in lanes
    ]
    speeds = np.array([float(lane.get("speed")) for lane in lanes])
    points = shapely.points(np.column_stack([x, y]))
    on = np.array([shapely.dwithin(shape, points, 0.5) for shape in shapes])
    assert on.any(axis=0).mean() > 0.95
    return np.where(on.any(axis=0), np.where(on, speeds[:, None], 0.0).max(axis=0), np.inf)


@pytest.mark.parametrize(
    ("controller", "ego", "fastest", "hardest"),
    [
        ("mpc", {"route": ("ab", "bc", "cd"), "initial_speed": 10.0}, 13.9, 2.5),
        ("pid-tuned", {"take_over": ("car",)}, 12.0, 3.2),
    ],
)
def test_no_limit_is_exceeded_and_bends_are_driven_in_comfort(
    drive: Callable[..., Any],
    scenario: Callable[..., Path],
    bent: Path,
    controller: str,
    ego: dict[str, Any],
    fastest: float,
    hardest: float,
) -> None:
    result, _ = drive(
        scenario(TAKEN if "take_over" in ego else "", net=bent),
        controller=controller,
        ego=ego,
        regulation={"reference_speed": "lane"},
    )
    track = result.ego_track
    assert result.ending is Ending.COMPLETED
    assert track.speed.max() == pytest.approx(fastest, abs=0.1)  # it does use the limit
    assert (track.speed - limits_along(bent, track.front_x, track.front_y)).max() < 0.3
    assert np.diff(track.speed).min() > -hardest * 0.05
    sideways = track.speed * np.gradient(np.unwrap(track.heading), track.time)
    assert 1.0 < np.abs(sideways).max() < 4.0  # side friction: at most 0.38 g
