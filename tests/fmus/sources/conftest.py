"""The exported controller in FMPy, and in a master of another make."""

from __future__ import annotations

import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave, fmi3LogMessageCallback

from controller import (
    LongitudinalModel,
    Mpc,
    MpcParameters,
    Observation,
    Pid,
    PidParameters,
    SpeedController,
)
from fmus.sources.export import export_controller

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fmus.sources.parameters import ControllerParameters

FAR = 1e9  # nobody


class Host:
    """One instance of the controller, driven by hand."""

    def __init__(self, fmu: Path, folder: Path, **start_values: float) -> None:
        self.description = read_model_description(str(fmu))
        self.is_fmi2 = self.description.fmiVersion == "2.0"
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.messages: list[str] = []
        self.fmu = self._make(folder)
        self.start_values = start_values
        self.instantiate()

    def _make(self, folder: Path) -> FMU2Slave | FMU3Slave:
        known = {
            "guid": self.description.guid,
            "unzipDirectory": str(folder),
            "modelIdentifier": self.description.coSimulation.modelIdentifier,
            "instanceName": "controller",
        }
        return FMU2Slave(**known) if self.is_fmi2 else FMU3Slave(**known)

    def instantiate(self) -> None:
        """With debug logging; what it says is in ``messages``."""
        if self.is_fmi2:
            self._callbacks = fmi2CallbackFunctions()
            self._callbacks.logger = fmi2CallbackLoggerTYPE(self._note_2)
            self.fmu.instantiate(callbacks=self._callbacks, loggingOn=True)
        else:
            self._log = fmi3LogMessageCallback(self._note_3)
            self.fmu.instantiate(loggingOn=True, logMessage=self._log)

    def _note_2(self, _env: Any, _name: Any, _status: int, _category: Any, text: bytes) -> None:
        self.messages.append(text.decode())

    def _note_3(self, _env: Any, _status: int, _category: Any, text: bytes) -> None:
        self.messages.append(text.decode())

    def initialise(self, start_time: float = 0.0) -> None:
        for name, value in self.start_values.items():
            self.set(name, value)
        if self.is_fmi2:
            self.fmu.setupExperiment(startTime=start_time)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=start_time)
        self.fmu.exitInitializationMode()

    def set(self, name: str, value: Any) -> None:
        reference = [self.references[name]]
        if isinstance(value, bool):
            self.fmu.setBoolean(reference, [value])
        elif name == "N":
            if self.is_fmi2:
                self.fmu.setInteger(reference, [value])
            else:
                self.fmu.enterConfigurationMode()
                self.fmu.setUInt64(reference, [value])
                self.fmu.exitConfigurationMode()
        else:
            (self.fmu.setReal if self.is_fmi2 else self.fmu.setFloat64)(reference, [value])

    def see(self, observation: Observation) -> None:
        """Set all inputs."""
        o = observation
        names = ["speed", "position", "gap", "speed_limit"]
        values = [o.speed, o.position, o.gap, o.speed_limit, *o.obstacle_positions]
        references = [self.references[name] for name in names]
        if self.is_fmi2:
            count = len(o.obstacle_positions)
            references += [self.references[f"obstacle_position[{i + 1}]"] for i in range(count)]
            self.fmu.setReal(references, values)
        else:
            self.fmu.setFloat64([*references, self.references["obstacle_position"]], values)

    def get(self, name: str) -> Any:
        reference = [self.references[name]]
        if name in ("acting", "infeasibility", "N"):
            call = self.fmu.getInteger if self.is_fmi2 else self.fmu.getInt32
            if name == "N" and not self.is_fmi2:
                call = self.fmu.getUInt64
        elif name in ("feasible", "mpc"):
            call = self.fmu.getBoolean
        else:
            call = self.fmu.getReal if self.is_fmi2 else self.fmu.getFloat64
        return call(reference)[0]

    def step(self, time: float, size: float) -> None:
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def refuses(self, call: Callable[[], object]) -> str:
        """The message of a call that must fail."""
        with pytest.raises(FMICallException):
            call()
        return self.messages[-1]

    def close(self) -> None:
        self.fmu.freeInstance()


@pytest.fixture
def new_host(tmp_path: Path) -> Iterator[Callable[..., Host]]:
    """Export a controller and instantiate it in FMPy."""
    with ExitStack() as stack:

        def make(
            fmi_version: str,
            parameters: ControllerParameters | None = None,
            *,
            initialised: bool = True,
            **start_values: Any,
        ) -> Host:
            number = len(list(tmp_path.glob("*.fmu")))
            fmu = export_controller(tmp_path / f"{number}.fmu", parameters, fmi_version=fmi_version)
            folder = Path(extract(str(fmu), unzipdir=str(tmp_path / f"{number}")))
            stack.callback(shutil.rmtree, folder, ignore_errors=True)
            host = Host(fmu, folder, **start_values)
            stack.callback(host.close)
            if initialised:
                host.initialise()
            return host

        yield make


@pytest.fixture(scope="session")
def regulator_of() -> Callable[[ControllerParameters], SpeedController]:
    """giveway's own regulator with the parameters of an export."""

    def make(p: ControllerParameters) -> SpeedController:
        pid = Pid(
            PidParameters(
                K_p=p.proportional_gain,
                K_i=p.integral_gain,
                K_d=p.derivative_gain,
                reference_speed=p.reference_speed,
                safe_distance=p.safe_distance,
                buffer_distance=p.buffer_distance,
                force_limit=p.force_limit,
            ),
            p.time_step,
        )
        if not p.mpc:
            return SpeedController(None, pid)
        model = LongitudinalModel(p.mass, p.friction, p.time_step)
        mpc = MpcParameters(
            horizon=p.horizon,
            reference_speed=p.reference_speed,
            safe_distance=p.safe_distance + p.margin,
            speed_min=p.speed_min,
            speed_max=p.speed_max,
            force_limit=p.force_limit,
            force_rate_limit=p.force_rate_limit,
        )
        return SpeedController(Mpc(model, mpc), pid)

    return make


@pytest.fixture(scope="session")
def seen() -> Callable[..., Observation]:
    """An observation; nobody is in front unless said otherwise."""

    def make(
        position: float = 0.0,
        speed: float = 0.0,
        obstacle: float = FAR,
        limit: float = FAR,
        horizon: int = 15,
    ) -> Observation:
        return Observation(position, speed, obstacle - position, np.full(horizon, obstacle), limit)

    return make


class Cosim:
    """A co-simulation in libcosim (Open Simulation Platform), through libcosimpy."""

    def __init__(self, step_size: float) -> None:
        from libcosimpy.CosimExecution import CosimExecution
        from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
        from libcosimpy.CosimManipulator import CosimManipulator
        from libcosimpy.CosimObserver import CosimObserver

        log_output_level(CosimLogLevel.WARNING)
        self.execution = CosimExecution.from_step_size(round(step_size * 1e9))  # [ns]
        self.execution.real_time_simulation_enabled(enabled=False)
        self.manipulator = CosimManipulator.create_override()
        self.observer = CosimObserver.create_last_value()
        self.execution.add_manipulator(self.manipulator)
        self.execution.add_observer(self.observer)

    def add(self, fmu: str, name: str) -> int:
        from libcosimpy.CosimSlave import CosimLocalSlave

        return int(self.execution.add_local_slave(CosimLocalSlave(fmu, name)))

    def step(
        self, slave: int, inputs: list[int], values: list[float], outputs: list[int]
    ) -> list[float]:
        """Set real inputs, step everything, read real outputs."""
        self.manipulator.slave_real_values(slave, inputs, [float(value) for value in values])
        assert self.execution.step()
        return self.read(slave, outputs)

    def read(self, slave: int, outputs: list[int]) -> list[float]:
        return list(self.observer.last_real_values(slave, outputs))


@pytest.fixture
def cosim() -> type[Cosim]:
    """A co-simulation master of another make."""
    pytest.importorskip("libcosimpy", reason="not installed: pip install libcosimpy")
    return Cosim
