"""What an identified model says of [vehicle]."""

import pytest

from fmus.profile.vehicle_profile import FittedModel, SideModel
from giveway.config.files.identified import identified_vehicle

MODEL = FittedModel(
    mass=12000.0,
    friction=110.0,
    r_squared=1.0,
    speed_error=0.0,
    position_error=0.1,
    horizon=0.75,
    time_step=0.05,
)


@pytest.mark.parametrize(
    ("limit", "force"),
    [(6.0, 72000.0), (2.0, 30000.0), (None, 96000.0)],
)
def test_the_stronger_side_limits_the_force(limit, force):
    drive = SideModel(mass=12000.0, limit=2.5)
    brake = SideModel(mass=12000.0, limit=limit)
    found = identified_vehicle(MODEL.model_copy(update={"drive": drive, "brake": brake}))
    assert found == {
        "mass": 12000.0,
        "friction": 110.0,
        "force_limit": force,
        "force_rate_limit": 12000.0,
    }


def test_without_sides_it_is_as_strong_as_the_default_car_of_its_mass():
    assert identified_vehicle(MODEL)["force_limit"] == 96000.0
