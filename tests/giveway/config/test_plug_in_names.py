"""Names of controllers, models and sensors."""

import pytest
from pydantic import TypeAdapter, ValidationError

from giveway.config.plug_in_names import BeliefName, ControllerName, SensorName


def test_the_papers_pid_keeps_its_old_name() -> None:
    assert TypeAdapter(ControllerName).validate_python("pid") == "pid-paper"


@pytest.mark.parametrize("name", ["mpc", "a.b:Driver", "driver.fmu", "DRIVER.FMU"])
def test_ours_classes_and_fmus_are_controllers(name: str) -> None:
    assert TypeAdapter(ControllerName).validate_python(name) == name


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (ControllerName, "mpcc"),
        (BeliefName, "jupedsim:NoSuchModel"),
        (BeliefName, "walker.fmu"),
        (SensorName, 3),
    ],
)
def test_another_name_is_refused_with_those_there_are(kind: object, name: object) -> None:
    with pytest.raises(ValidationError, match=r"expected '.*module:Class of an installed package"):
        TypeAdapter(kind).validate_python(name)
