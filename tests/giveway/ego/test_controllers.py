"""The configuration's defaults are those of the rooms that use them, which cannot import it."""

from __future__ import annotations

import dataclasses
from typing import get_args

import pytest

from controller import (
    STYLES,
    LongitudinalModel,
    ManoeuvreParameters,
    MpcParameters,
    PeopleName,
    PidParameters,
    PlannerParameters,
    ReferenceParameters,
    SafetyParameters,
    StyleName,
    TunedPidParameters,
)
from controller.driving_constants import STANDING
from fmus.sources.parameters import ControllerParameters
from giveway.config import EgoRunConfig
from giveway.config.option import LANE
from giveway.config.tables.basics import DEFAULT_SPEED
from giveway.config.tables.controllers import (
    PaperMpcOptions,
    PlannerOptions,
    SafetyConfig,
    TunedPidOptions,
)
from giveway.ego.controllers import filled, make_controller, manoeuvres_of
from giveway.ego.preparation import safety_parameters
from giveway.geometry.bodies import BODY
from pedestrian_model import SIM

STEP = 0.05  # [s]
TUNED, PLANNING, PAPER = TunedPidOptions(), PlannerOptions(), PaperMpcOptions()
CONFIG = EgoRunConfig.model_validate({"regulation": {"reference_speed": DEFAULT_SPEED}})


@pytest.mark.parametrize(
    ("kind", "tables", "own"),
    [
        (LongitudinalModel, ["vehicle"], {"time_step": STEP}),
        (MpcParameters, [PAPER, "vehicle", "regulation"], {}),
        (PidParameters, ["regulation", PAPER, "vehicle"], {}),
        (ReferenceParameters, ["regulation", TUNED], {}),
        (TunedPidParameters, [TUNED, "vehicle"], {}),
        (PlannerParameters, ["regulation", PLANNING, "vehicle"], {"horizon": 50}),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_the_controllers_defaults_are_the_configurations(kind, tables, own):
    assert (
        filled(kind, *(getattr(CONFIG, t) if isinstance(t, str) else t for t in tables), **own)
        == kind()
    )


def test_the_paper_s_gains_are_the_configurations():
    pid, gains = PidParameters(), PAPER
    assert (pid.K_p, pid.K_i, pid.K_d) == (
        gains.proportional_gain,
        gains.integral_gain,
        gains.derivative_gain,
    )
    assert PlannerParameters().horizon == round(PLANNING.horizon / STEP)


def test_a_stop_is_recorded_below_the_speed_at_which_an_ego_stands():
    assert CONFIG.record.stop_speed == STANDING


def test_the_safety_layers_defaults_are_the_configurations():
    assert safety_parameters(CONFIG, STEP) == SafetyParameters()
    assert SafetyParameters().width == BODY.width
    milder = safety_parameters(EgoRunConfig(safety={"people": "responsible"}), STEP)
    assert (milder.walking_acceleration, milder.walking_speed) == (2.2, 2.8)
    assert SafetyParameters().walking_speed >= SIM.max_speed
    chosen = SafetyConfig.model_fields["people"].annotation
    assert get_args(chosen) == get_args(PeopleName)


def test_exported_controllers_have_the_configurations_defaults():
    exported = dataclasses.asdict(ControllerParameters())
    ours = {
        **CONFIG.regulation.model_dump(),
        **CONFIG.vehicle.model_dump(),
        **PAPER.model_dump(),
    }
    shared = exported.keys() & ours.keys()
    assert len(shared) >= 10
    assert {name: exported[name] for name in shared} == {name: ours[name] for name in shared}


def test_lanes_say_how_fast_but_not_to_the_paper_s_controllers():
    for name in ("mpc", "pid-tuned", "idm", "package:Driver"):
        assert EgoRunConfig(controller=name).reference_speed == LANE
    for name in ("mpc-paper", "pid-paper"):
        assert EgoRunConfig(controller=name).reference_speed == DEFAULT_SPEED
        told = EgoRunConfig.model_validate(
            {"controller": name, "regulation": {"reference_speed": "lane"}}
        )
        assert told.reference_speed == LANE
    planner = make_controller(EgoRunConfig(), STEP, 9.5).planner
    assert planner.parameters.reference_speed == 9.5
    paper = make_controller(EgoRunConfig(controller="pid-paper"), STEP, None)
    assert paper.pid.parameters.reference_speed == DEFAULT_SPEED


def test_a_style_sets_what_the_options_leave_out():
    assert manoeuvres_of(PLANNING) == ManoeuvreParameters()
    chosen = PlannerOptions.model_fields["style"].annotation
    assert get_args(chosen) == get_args(StyleName) == tuple(STYLES)
    for name, usual in STYLES.items():
        found = manoeuvres_of(PlannerOptions(style=name), margin=0.1)
        assert found.precaution_weight == usual
        assert found.minimum_distance == ManoeuvreParameters().minimum_distance + 0.1
        set_ = manoeuvres_of(PlannerOptions(style=name, precaution_weight=5.5))
        assert set_.precaution_weight == 5.5


def test_an_option_reaches_the_parameter_of_its_name():
    config = EgoRunConfig.model_validate(
        {"vehicle": {"force_limit": 5000.0}, "regulation": {"reference_speed": 4.0}}
    )
    tables = config.regulation, PAPER, config.vehicle
    assert filled(PidParameters, *tables).force_limit == 5000.0
    assert filled(PidParameters, config.vehicle, force_limit=6000.0).force_limit == 6000.0
