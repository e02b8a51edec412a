"""The speed from which a background vehicle stops before a person, or behind an ego."""

import pytest

from giveway.cosimulation.traffic.yielding import _safe_speed


@pytest.mark.parametrize("room", [0.0, 0.5, 20.0])
@pytest.mark.parametrize("leader", [0.0, 6.0])
def test_a_vehicle_stops_in_its_room_after_the_reaction_time(room: float, leader: float) -> None:
    speed = _safe_speed(room, leader, 4.5, 1.0)
    stops = speed * 1.0 + speed**2 / 9.0
    assert stops == pytest.approx(room + leader**2 / 9.0)
    assert _safe_speed(-1.0, 0.0, 4.5, 1.0) == 0.0
