"""The types that giveway adds to a scenario."""

from xml.etree import ElementTree

import pytest

from giveway.errors import ScenarioError
from giveway.geometry.bodies import VehicleShape
from giveway.sumo.types import PEDESTRIAN_TYPE, ROAD_CLASSES, all_types, ego_type, inserted_type


def test_the_file_has_a_type_for_every_ego_and_for_people() -> None:
    text = all_types({inserted_type('a "b" & c'): VehicleShape(12.0, 2.5)})
    types = {element.get("id"): element for element in ElementTree.fromstring(text)}
    own = types[inserted_type('a "b" & c')]
    assert (own.get("length"), own.get("width")) == ("12.0", "2.5")
    assert PEDESTRIAN_TYPE in types
    assert {ego_type(name) for name in ROAD_CLASSES} < set(types)


def test_no_type_draws_a_random_number() -> None:
    elements = ElementTree.fromstring(all_types({}))
    assert {element.get("speedDev") for element in elements} == {"0"}


def test_a_train_is_no_ego() -> None:
    with pytest.raises(ScenarioError, match=r"'rail': .*passenger.*--ego"):
        ego_type("rail")
