"""The target of each pedestrian: where they stop before a signal that closes."""

import numpy as np
import pytest

from pedestrian_model import PRESETS, Crowd, CrowdModel, Surroundings, Vehicles, Walls

STEP = 0.05
LINE, END = 0.0, 10.0  # [m] the kerb, and the end of the route


def walk(preset: str, speed: float, begin: float, closed: bool = True) -> np.ndarray:
    """Return where someone is at each step who walks up to a line at which a signal closes."""
    crowd = Crowd.create(
        [[begin, 0.0]],
        [[speed, 0.0]],
        [speed],
        [[(LINE, 0.0), (END, 0.0)]],
        passages=[[(1.0, 0.0, 2.0), (0.0, 0.0, 0.0)]],
        signals=[[0, -1]],
    )
    model = CrowdModel(PRESETS[preset], STEP)
    surroundings = Surroundings(closed=np.array([closed]))
    places = []
    for _ in range(200):
        model.advance(crowd, Vehicles.empty(), surroundings)
        places.append(crowd.position[0, 0])
    return np.array(places)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("speed", [0.6, 1.4, 2.2])
def test_nobody_gets_far_over_a_line_that_closes_ahead(preset: str, speed: float) -> None:
    at_least = 0.5 * speed**2 / 5.0  # way [m] of a stop with 5 m/s^2
    for begin in (-4.0, -2.0, -1.0, -0.5, -0.1):
        over = walk(preset, speed, begin).max()
        assert over < max(0.0, at_least + begin) + 0.12, begin


@pytest.mark.parametrize("preset", PRESETS)
def test_who_waits_stands_at_the_line(preset: str) -> None:
    places = walk(preset, 1.4, -3.0)
    assert abs(places[-1] - LINE) < 0.05
    assert np.abs(np.diff(places[-40:])).max() < 1e-3


@pytest.mark.parametrize("preset", PRESETS)
def test_an_open_signal_holds_nobody(preset: str) -> None:
    assert walk(preset, 1.4, -3.0, closed=False).max() > END - 0.5


@pytest.mark.parametrize("preset", PRESETS)
def test_a_wall_holds_people_in_its_own_direction_only(preset: str) -> None:
    row = [0.6 * i for i in range(6)]
    crowd = Crowd.create(
        [[x, -2.0] for x in row], [[0.0, 1.4]] * 6, [1.4] * 6, [[(x, 10.0)] for x in row]
    )
    surroundings = Surroundings(walls=Walls.create([[50.0, 0.0, -50.0, 0.0]]))
    model, before = CrowdModel(PRESETS[preset], STEP), crowd.velocity.copy()
    for _ in range(200):
        model.advance(crowd, Vehicles.empty(), surroundings)
        aside = np.abs(crowd.velocity - before)[:, 0] / STEP
        assert aside.max() <= PRESETS[preset].max_acceleration + 1e-9
        before = crowd.velocity.copy()
    assert crowd.position[:, 1].max() < 0.0
