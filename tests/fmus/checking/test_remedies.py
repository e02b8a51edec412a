"""A line is told only if the vehicle drives and stops right with it."""

from types import SimpleNamespace

import pytest

from fmus import bundled_fmu
from fmus.checking import expected_of
from fmus.checking.remedies import MOST, _switches, tried
from fmus.description.model import Variable
from fmus.profile.vehicle_profile import make_profile


def lines(zoo, known=None, changes=None, **options):
    path = zoo.car(**options)
    profile = make_profile(zoo.profile(path) | (changes or {}), "test")
    found = tried(path, expected_of(profile, mass=known), step_size=0.05)
    return None if found is None else found.lines


@pytest.mark.parametrize(
    ("options", "known", "line"),
    [
        ({"spoken": {"position": (1000.0, 0.0)}}, None, '`unit = "km"` in [outputs.position]'),
        (
            {"spoken": {"force": (4.448222, 0.0)}, "outputs": ("speed",)},
            1000.0,
            '`unit = "lbf"` in [inputs.force]',
        ),
    ],
)
def test_the_line_that_mends_it(zoo, options, known, line):
    assert lines(zoo, known, **options) == line


def test_the_lead_of_a_set_point_is_found(zoo):
    """The speed controller takes 0.5 s; without a lead it seems ten times as heavy."""
    without = {"inputs": {"speed_setpoint": {"variable": "speed_setpoint"}}}
    found = lines(zoo, changes=without, role="speed_setpoint")
    assert found == "`lead = 0.53` in [inputs.speed_setpoint]"


def test_gear_ignition_and_selector_are_tried_together():
    starts = {"Mode": ("Enumeration", "1"), "gear": ("Int8", "0"), "ignition": ("Boolean", "false")}
    variables = {
        name: Variable(name, 1, kind, "input", start=start)
        for name, (kind, start) in starts.items()
    }
    edits = [edit for _, edit in _switches({"inputs": {}}, SimpleNamespace(variables=variables))]
    assert {"parameters": {"Mode": 4, "gear": 1, "ignition": True}} in [
        {"parameters": edit["parameters"]} for edit in edits
    ]
    assert len(edits) < MOST // 2


def test_an_edit_that_lets_the_brakes_drive_is_no_remedy():
    profile = make_profile(
        {
            "fmu": {"step": 2.05},
            "inputs": {"force": {"variable": "force"}},
            "outputs": {role: {"variable": role} for role in ("speed", "position")},
            "initial": {"run_up": True, "speed": {"variable": "v0"}},
            "limits": {"speed": 100.0},
        },
        "test",
    )
    path = bundled_fmu("3.0")
    assert tried(path, expected_of(profile, mass=1000.0), step_size=0.05) is None
