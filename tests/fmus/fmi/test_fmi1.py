"""FMI 1.0 for Model Exchange, and events in quick succession: a bouncing ball."""

from __future__ import annotations

import importlib.util
import shutil
import zipfile
from math import sqrt
from pathlib import Path

import fmpy
import pytest

from fmus import FmuStartError
from fmus.fmi import cvode
from fmus.sources.compiler import TARGETS, compile_library

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None,
    reason="ziglang is not installed: pip install giveway[build]",
)
G, E = 9.81, 0.7  # [m/s2], restitution
DESCRIPTION = """<?xml version="1.0"?>
<fmiModelDescription fmiVersion="1.0" modelName="ball" modelIdentifier="ball" guid="{guid}"
    numberOfContinuousStates="2" numberOfEventIndicators="1">
  <ModelVariables>
    <ScalarVariable name="h" valueReference="0" causality="output"><Real start="1"/></ScalarVariable>
    <ScalarVariable name="v" valueReference="1" causality="output"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="gravity" valueReference="2" causality="input"><Real start="9.81"/></ScalarVariable>
    <ScalarVariable name="restitution" valueReference="3" variability="parameter"><Real start="0.7"/></ScalarVariable>
    <ScalarVariable name="bounces" valueReference="4" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="friction" valueReference="5" variability="parameter"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="moving" valueReference="6" causality="output" variability="discrete"><Boolean start="true"/></ScalarVariable>
  </ModelVariables>
</fmiModelDescription>
"""  # noqa: E501
SOLVERS = ["rk4"] + ["cvode"] * cvode.available()


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    here = next(target for target in TARGETS if target.folder == fmpy.platform_tuple)
    folder = tmp_path_factory.mktemp("ball")
    shutil.copy(Path(__file__).with_name("fmi1_ball.c"), folder)
    return here.suffix, compile_library(folder, ("fmi1_ball.c",), here, "ball")


@pytest.fixture
def ball(library, tmp_path):
    def make(guid="{ball}"):
        path = tmp_path / "ball.fmu"
        suffix, binary = library
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("modelDescription.xml", DESCRIPTION.replace("{guid}", guid))
            archive.writestr(f"binaries/{fmpy.platform}/ball{suffix}", binary)
        return path

    return make


OUTPUTS = ("h", "v", "bounces", "moving")


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_first_bounces_are_where_they_should_be(ball, run, solver):
    state = run(ball(), {"gravity": G}, 14, outputs=OUTPUTS, solver=solver)
    fall = sqrt(2.0 / G)  # [s] from 1 m
    since = 0.7 - fall  # after the first bounce, before the second
    speed = E * G * fall
    expected = [speed * since - 0.5 * G * since**2, speed - G * since, 1.0, 1.0]
    assert list(state.outputs) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("solver", SOLVERS)
def test_many_bounces_within_one_step_until_it_lies(ball, run, solver):
    state = run(ball(), {"gravity": G}, 1, step=4.0, outputs=OUTPUTS, solver=solver)
    assert state.status == 0
    assert list(state.outputs) == [0.0, 0.0, 18.0, 0.0]


@pytest.mark.parametrize("solver", SOLVERS)
def test_bounces_without_end_are_chattering(ball, run, solver):
    values = {"restitution": 1.0}
    state = run(ball(), {"gravity": 1e9}, 1, values=values, outputs=OUTPUTS, solver=solver)
    assert state.status == 3
    said = state.messages.take()
    assert said.startswith("more than 200 events between 0 s and 0.0")
    assert said.endswith(": it chatters")


def test_a_wrong_guid_is_refused_in_the_fmus_words(ball, run):
    with pytest.raises(FmuStartError, match=r"ball_fmiInstantiateModel .*wrong GUID \{other\}"):
        run(ball("{other}"), {"gravity": G}, 1, outputs=OUTPUTS)


@pytest.mark.parametrize(
    ("solver", "status"), [(None, 0), ("rk4", 0)] + [("cvode", 3)] * cvode.available()
)
def test_dry_friction_without_events(ball, run, solver, status):
    """v' = -mu sign(v): CVode never comes to rest; left to itself the choice falls on the other."""
    inputs, values = {"gravity": 0.0}, {"v": 1.0, "friction": 3.0}
    state = run(ball(), inputs, 20, values=values, outputs=("v",), solver=solver)
    assert state.status == status
    if status == 0:
        assert abs(state.outputs[0]) < 1e-3
    else:
        assert "use a greater `tolerance` under [fmu]" in state.messages.take()
