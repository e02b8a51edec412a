"""How severe conflicts were: a car drives past, towards or into people who stand."""

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import pedestrian_metrics, severities
from tests.giveway.metrics.conftest import make_crowd, straight_ego

SHAPE = VehicleShape(5.0, 2.0)
RADIUS = 0.25


def _severity(last: float, place: tuple[float, float], speed: float = 4.0):  # type: ignore[no-untyped-def]
    """Of one who stands at ``place``; the ego drives from x = 0 until the time ``last``."""
    time = np.arange(0.0, last + 1e-9, 0.05)
    ego = straight_ego(time, speed)
    crowd = make_crowd((0, [(*place, 0.0, 0.0)] * len(time)))
    table = pedestrian_metrics(ego, crowd, SHAPE, RADIUS)
    return severities(ego, crowd, SHAPE, RADIUS, 0.2, table).iloc[0]


@pytest.mark.parametrize(
    ("last", "severity", "ttc"),
    [(1.0, "", np.nan), (2.7, "slight", 1.3), (3.2, "serious", 0.8), (4.2, "collision", 0.0)],
)
def test_class_by_time_to_collision(last: float, severity: str, ttc: float) -> None:
    """The skin of who stands at 16.25 m is 4 s ahead of the bumper at 4 m/s."""
    found = _severity(last, (16.25, 0.0))
    assert found["severity"] == severity
    assert found["conflict_ttc"] == pytest.approx(ttc, nan_ok=True)
    if severity:
        assert found["conflict_speed"] == pytest.approx(4.0)
        assert (found["conflict_x"], found["conflict_y"]) == (16.25, 0.0)
    else:
        assert np.isnan(found["conflict_x"])


def test_who_is_passed_by_has_no_conflict() -> None:
    assert _severity(6.0, (16.25, 2.0))["severity"] == ""


def test_a_narrow_miss_in_time_alone_is_slight() -> None:
    """It walks along a standing line that the ego has left 0.5 s before."""
    time = np.arange(0.0, 6.0, 0.05)
    ego = straight_ego(time, 4.0)
    # The rear bumper is at x = 10 at 3.75 s; the skin enters the strip |y| < 1 at 4.25 s.
    y = 1.25 + 1.0 * (4.25 - time)
    crowd = make_crowd((0, [(10.0 - RADIUS, float(at), 0.0, -1.0) for at in y]))
    table = pedestrian_metrics(ego, crowd, SHAPE, RADIUS)
    found = severities(ego, crowd, SHAPE, RADIUS, 0.2, table).iloc[0]
    assert 0.0 < table["post_encroachment_time"][0] <= 1.0
    assert found["severity"] == "slight"
    assert np.isnan(found["conflict_ttc"])
    assert np.isfinite(found["conflict_time"])
