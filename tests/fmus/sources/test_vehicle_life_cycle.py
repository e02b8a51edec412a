"""The FMUs as any host meets them: what the standard allows, and what is refused with a reason."""

from __future__ import annotations

import math
import shutil

import pytest
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave

H = 0.05  # [s]


class Host:
    """A bare FMPy host with the same few words for both FMI versions."""

    def __init__(self, path, folder, guid=None):
        description = read_model_description(str(path))
        self.vr = {v.name: v.valueReference for v in description.modelVariables}
        self.said = []
        self.fmi2 = description.fmiVersion == "2.0"
        self.slave = (FMU2Slave if self.fmi2 else FMU3Slave)(
            guid=guid or description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=str(extract(str(path), folder)),
        )

    def instantiate(self):
        if self.fmi2:
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = fmi2CallbackLoggerTYPE(
                lambda env, name, status, category, text: self.said.append((status, category))
            )
            self.slave.instantiate(callbacks=callbacks)
        else:
            self.slave.instantiate(
                logMessage=lambda env, status, category, text: self.said.append((status, category))
            )

    def initialise(self, **values):
        if self.fmi2:
            self.slave.setupExperiment(startTime=0.0)
        self.set(**values)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def ready(self, **values):
        self.instantiate()
        self.initialise(**values)
        return self

    def set(self, **values):
        setter = self.slave.setReal if self.fmi2 else self.slave.setFloat64
        setter([self.vr[name] for name in values], list(values.values()))

    def get(self, *names):
        getter = self.slave.getReal if self.fmi2 else self.slave.getFloat64
        return tuple(getter([self.vr[name] for name in names]))

    def refuses(self, function, *arguments, **keywords):
        """The call is an error, and exactly one message of category logStatusError says why."""
        self.said.clear()
        with pytest.raises(FMICallException) as caught:
            function(*arguments, **keywords)
        return caught.value.status == 3 and self.said == [(3, b"logStatusError")]


@pytest.fixture
def host(fmu, tmp_path):
    host = Host(fmu, str(tmp_path / "unzipped"))
    yield host
    if host.slave.component:
        host.slave.freeInstance()
    shutil.rmtree(tmp_path / "unzipped", ignore_errors=True)


def test_outputs_follow_the_start_values_during_initialisation(host):
    host.instantiate()
    host.set(s0=5.0, v0=2.0)
    assert host.get("position", "speed", "acceleration") == (5.0, 2.0, 0.0)


def test_another_builds_token_is_refused(fmu, tmp_path):
    host = Host(fmu, str(tmp_path), guid="{00000000-0000-0000-0000-000000000000}")
    with pytest.raises(Exception, match="Failed to instantiate"):
        host.instantiate()
    assert host.said == [(3, b"logStatusError")]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_force_that_is_nan_is_refused_and_changes_nothing(host, value):
    host.ready(v0=2.0)
    host.set(force=100.0)
    assert host.refuses(host.set, force=value)
    assert host.get("force") == (100.0,)


@pytest.mark.parametrize(
    ("name", "value"), [("M", 0.0), ("M", -1.0), ("alpha", -0.1), ("v0", -0.1)]
)
def test_meaningless_parameters_are_refused_at_initialisation(host, name, value):
    host.instantiate()
    assert host.refuses(host.initialise, **{name: value})


def test_calls_out_of_order_are_refused(host):
    host.instantiate()
    assert host.refuses(host.slave.doStep, 0.0, H)
    assert host.refuses(host.slave.exitInitializationMode)
    assert host.refuses(host.slave.terminate)
    host.initialise()
    assert host.refuses(host.slave.enterInitializationMode)
    host.slave.terminate()
    assert host.refuses(host.slave.doStep, 0.0, H)
    assert host.refuses(host.set, force=1.0)


def test_parameters_are_fixed_once_running(host):
    host.ready()
    assert host.refuses(host.set, M=500.0)


@pytest.mark.parametrize("name", ["position", "speed", "acceleration", "time"])
def test_what_is_calculated_cannot_be_set(host, name):
    host.instantiate()
    assert host.refuses(host.set, **{name: 1.0})


@pytest.mark.parametrize("size", [0.0, -H, math.nan, math.inf])
def test_a_step_needs_a_length(host, size):
    host.ready()
    assert host.refuses(host.slave.doStep, 0.0, size)


def test_a_step_from_another_time_than_the_vehicles_is_refused(host):
    host.ready(v0=1.0)
    host.slave.doStep(0.0, H)
    assert host.refuses(host.slave.doStep, 0.0, H)
    assert host.get("time", "position") == (H, H)


def test_steps_may_differ_in_length(host):
    host.ready(v0=1.0, alpha=0.0)
    for start, size in ((0.0, 0.5), (0.5, 0.25), (0.75, 1.0)):
        host.slave.doStep(start, size)
    assert host.get("time", "position") == (1.75, 1.75)


def test_reset_goes_back_to_the_defaults_of_a_new_instance(host):
    host.ready(v0=3.0, M=700.0)
    host.slave.doStep(0.0, H)
    host.slave.reset()
    assert host.get("M", "v0", "position", "speed", "time") == (1000.0, 0.0, 0.0, 0.0, 0.0)
    host.initialise(v0=1.0)
    host.slave.doStep(0.0, H)
    assert host.get("position") == (H,)


def test_a_serialised_state_continues_in_another_instance(host, fmu, tmp_path):
    serialize = "serializeFMUstate" if host.fmi2 else "serializeFMUState"
    deserialize = "deSerializeFMUstate" if host.fmi2 else "deserializeFMUState"
    host.ready(v0=3.0, M=700.0)
    host.set(force=-500.0)
    host.slave.doStep(0.0, H)
    state = host.slave.getFMUState()
    data = getattr(host.slave, serialize)(state)
    host.slave.freeFMUState(state)
    host.slave.doStep(H, H)
    expected = host.get("time", "position", "speed", "acceleration")

    other = Host(fmu, str(tmp_path / "other")).ready()
    other.slave.doStep(0.0, H)  # with its own mass, which must not live on
    other.slave.setFMUState(getattr(other.slave, deserialize)(data))
    other.slave.doStep(H, H)
    assert other.get("time", "position", "speed", "acceleration") == expected
    other.slave.freeInstance()
