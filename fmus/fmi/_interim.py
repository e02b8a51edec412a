# Only until fmus/vehicle.py runs on the new instances.
"""Reading, loading and calling FMUs: the only file that talks to FMPy.

FMPy reads the model description, loads the binary and knows the C functions. Only the three calls
of a step go past its wrappers: their arguments are made once and used for every step.
"""

import hashlib
import os
import weakref
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from ctypes import CDLL, byref, c_bool, c_double, c_int, c_size_t, c_uint32, c_void_p
from pathlib import Path
from types import MappingProxyType
from typing import Any

import fmpy
from fmpy import fmi2, fmi3
from fmpy.fmi1 import FMICallException
from fmpy.model_description import read_model_description

from fmus.errors import (
    FmuFileError,
    FmuInterfaceError,
    FmuPlatformError,
    FmuStartError,
    FmuStateError,
)
from fmus.fmi._interim_instance import DISCARD, WARNING, Instance, Journal, Tick
from fmus.fmi._interim_model import FmuDescription, Model, Variable

# ---- reading ----


def describe(path: str | os.PathLike[str]) -> FmuDescription:
    """Name, version and fingerprint of an FMU.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
    """
    path = Path(path)
    xml = _model_description(path)
    return FmuDescription(
        name=xml.modelName,
        fmi_version=xml.fmiVersion,
        guid=xml.guid,
        generation_tool=xml.generationTool or "",
        sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
    )


def read_model(path: Path) -> Model:
    """What is needed to run an FMU here.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: it is not for Co-Simulation with FMI 2.0 or 3.0.
        FmuPlatformError: it has no binary for this platform.
    """
    xml = _model_description(path)
    version = xml.fmiVersion[:3]
    if version not in {"2.0", "3.0"}:
        msg = f"{path}: FMI version {xml.fmiVersion}; expected 2.0 or 3.0; export the model again"
        raise FmuInterfaceError(msg)
    if xml.coSimulation is None:
        msg = f"{path}: no Co-Simulation interface; export the model for Co-Simulation"
        raise FmuInterfaceError(msg)
    return Model(
        path=path,
        fmi_version=version,
        guid=xml.guid,
        identifier=xml.coSimulation.modelIdentifier,
        folder=_binary_folder(path, version, xml.coSimulation.modelIdentifier),
        variables=MappingProxyType({v.name: _variable(v) for v in xml.modelVariables}),
        saves_state=bool(xml.coSimulation.canGetAndSetFMUstate),
    )


def load(model: Model) -> Instance:
    """Load an FMU's library, ready to be started.

    Raises:
        FmuFileError: the archive is damaged.
        FmuPlatformError: the binary cannot be loaded.
    """
    return _Fmi2Instance(model) if model.fmi_version == "2.0" else _Fmi3Instance(model)


def _model_description(path: Path) -> Any:
    if not path.is_file():
        msg = f"{path}: no such file; expected an FMU (.fmu)"
        raise FmuFileError(msg)
    try:
        # FMPy's validation would refuse FMUs of well-known tools that run without a fault.
        return read_model_description(str(path), validate=False)
    except zipfile.BadZipFile:
        msg = f"{path}: not a zip archive, or cut off; expected an FMU; copy or export it again"
    except KeyError:
        msg = f"{path}: no modelDescription.xml in the archive; expected an FMU"
    except Exception as error:  # whatever FMPy and its XML parser meet in a broken file
        msg = f"{path}: modelDescription.xml cannot be read: {_line(error)}; export the model again"
    raise FmuFileError(msg)


def _variable(v: Any) -> Variable:
    free = v.causality in {"parameter", "structuralParameter", "input"}
    return Variable(
        name=v.name,
        reference=v.valueReference,
        kind=v.type,
        causality=v.causality,
        scalar=not v.dimensions,
        settable=v.variability != "constant" and (free or v.initial in {"exact", "approx"}),
    )


def _binary_folder(path: Path, version: str, identifier: str) -> str:
    """The folder of this platform's binary: FMI 3's name for it or, in FMI 2, the older one.

    FMPy knows only the older names for FMI 2, and takes the x86-64 'linux64' on every Linux.
    """
    names = [fmpy.platform_tuple]
    if version == "2.0" and (fmpy.architecture == "x86_64" or fmpy.system == "darwin"):
        names.insert(0, fmpy.platform)
    library = identifier + fmpy.sharedLibraryExtension
    with zipfile.ZipFile(path) as archive:
        members = set(archive.namelist())
    for name in names:
        if f"binaries/{name}/{library}" in members:
            return f"binaries/{name}"
    present = sorted({m.split("/")[1] for m in members if m.startswith("binaries/") and m[9:]})
    msg = (
        f"{path}: no binaries/{names[0]}/{library} for this platform; the FMU has binaries for: "
        f"{', '.join(present) or 'none'}; export it for {fmpy.platform_tuple}"
    )
    raise FmuPlatformError(msg)


def _line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__


# ---- messages ----

# FMI 2 messages are printf formats with arguments. FMPy has a C function that expands them, but one
# for the whole process: so is our receiver, which knows an instance by its environment pointer.
_journals: weakref.WeakValueDictionary[int, Journal] = weakref.WeakValueDictionary()


def _receive(
    environment: int | None, _name: bytes, status: int, _category: bytes, message: bytes | None
) -> None:
    journal = _journals.get(environment or 0)
    if journal is not None and (_FORMATS_MESSAGES or b"%" not in (message or b"")):
        journal.add(status, message)


# It has none for Linux on ARM: there, messages that need expansion are left out.
_FORMATS_MESSAGES = hasattr(fmi2, "addLoggerProxy")

_RECEIVER = fmi2.fmi2CallbackLoggerTYPE(_receive)  # lives as long as any FMU may call it


def _fmi2_callbacks(journal: Journal) -> Any:
    _journals[id(journal)] = journal
    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = _RECEIVER
    callbacks.allocateMemory = fmi2.defaultCallbacks.allocateMemory
    callbacks.freeMemory = fmi2.defaultCallbacks.freeMemory
    callbacks.componentEnvironment = id(journal)
    if _FORMATS_MESSAGES:
        fmi2.addLoggerProxy(byref(callbacks))
    return callbacks


# ---- running ----


def _function(library: CDLL, name: str) -> Callable[..., int]:
    """A C function that takes ready-made ctypes objects as they are, without conversions."""
    return library[name]


class _FmpyInstance(Instance):
    """What FMPy's classes for FMI 2 and FMI 3 have in common."""

    _slave_class: type[Any]
    _fmu: Any

    def load(self, folder: Path) -> Callable[[], None]:
        model = self.model
        library = folder / model.folder / (model.identifier + fmpy.sharedLibraryExtension)
        here = Path.cwd()
        try:
            self._fmu = self._slave_class(
                guid=model.guid,
                modelIdentifier=model.identifier,
                unzipDirectory=str(folder),
                instanceName=model.identifier,
                libraryPath=str(library),
            )
        except Exception as error:
            reason = _line(error).replace(f"{folder}{os.sep}", "")
            msg = f"{model.path}: its binary cannot be used: {reason}; export the FMU again"
            raise FmuPlatformError(msg) from error
        finally:
            os.chdir(here)  # FMPy stays in the library's folder when loading fails
        return self._unload

    def _unload(self) -> None:
        self._fmu.freeLibrary()

    def terminate(self) -> None:
        if self._fmu.component:
            self._fmu.terminate()

    def save(self) -> Any:
        with self._refusal("does not save its state"):
            return self._fmu.getFMUState()

    def restore(self, state: Any) -> None:
        with self._refusal("does not return to the saved state"):
            self._fmu.setFMUState(state)

    def free_state(self, state: Any) -> None:
        with suppress(FMICallException):  # nothing is left to do for a state that stays
            self._fmu.freeFMUState(state)

    @contextmanager
    def _refusal(self, what: str) -> Iterator[None]:
        try:
            yield
        except FMICallException as error:
            reason = self.journal.take() or str(error)
            msg = f"{self.model.path}: the FMU {what}: {reason}; start the vehicle again"
            raise FmuStateError(msg) from error

    def _require_read(self, status: int) -> None:
        if status > WARNING:
            msg = f"{self.model.path}: the outputs cannot be read: {self.journal.take()}"
            raise FmuStartError(msg)


class _Fmi2Instance(_FmpyInstance):
    _slave_class = fmi2.FMU2Slave

    def instantiate(self) -> None:
        # With logging on, for the reason of a failure: some FMUs give it only then.
        self._fmu.instantiate(callbacks=_fmi2_callbacks(self.journal), loggingOn=True)

    def set_real(self, reference: int, value: float) -> None:
        self._fmu.setReal([reference], [value])

    def set_boolean(self, reference: int, value: bool) -> None:
        self._fmu.setBoolean([reference], [value])

    def initialise(self) -> None:
        self._fmu.setupExperiment(startTime=0.0)
        self._fmu.enterInitializationMode()
        self._fmu.exitInitializationMode()

    def free_instance(self) -> None:
        if self._fmu.component:
            self._fmu.fmi2FreeInstance(self._fmu.component)
            self._fmu.component = None

    def link(self, force: int, outputs: Sequence[int], step_size: float) -> Tick:
        library, c = self._fmu.dll, c_void_p(self._fmu.component)
        set_real, do_step, get_real = (
            _function(library, name) for name in ("fmi2SetReal", "fmi2DoStep", "fmi2GetReal")
        )
        u_references, one, u = (c_uint32 * 1)(force), c_size_t(1), c_double()
        y_references, three, y = (c_uint32 * 3)(*outputs), c_size_t(3), self.buffer
        u_address, t, h = byref(u), c_double(), c_double(step_size)
        rollback_possible = c_int(fmi2.fmi2False)

        self._require_read(get_real(c, y_references, three, y))

        def tick(force: float, time: float) -> int:
            u.value = force
            t.value = time
            status = set_real(c, u_references, one, u_address)
            if status > WARNING:
                return status
            status = do_step(c, t, h, rollback_possible)
            if status > WARNING:
                return status
            return get_real(c, y_references, three, y)

        return tick


class _Fmi3Instance(_FmpyInstance):
    _slave_class = fmi3.FMU3Slave

    def instantiate(self) -> None:
        journal = self.journal  # not self: FMPy keeps the receiver, and we keep FMPy's object

        def receive(_environment: int, status: int, _category: bytes, message: bytes) -> None:
            journal.add(status, message)

        self._fmu.instantiate(loggingOn=True, logMessage=receive)  # on: as for FMI 2

    def set_real(self, reference: int, value: float) -> None:
        self._fmu.setFloat64([reference], [value])

    def set_boolean(self, reference: int, value: bool) -> None:
        self._fmu.setBoolean([reference], [value])

    def initialise(self) -> None:
        self._fmu.enterInitializationMode(startTime=0.0)
        self._fmu.exitInitializationMode()

    def free_instance(self) -> None:
        if self._fmu.component:
            self._fmu.fmi3FreeInstance(self._fmu.component)
            self._fmu.component = None

    def link(self, force: int, outputs: Sequence[int], step_size: float) -> Tick:
        library, c = self._fmu.dll, c_void_p(self._fmu.component)
        set_real, do_step, get_real = (
            _function(library, name) for name in ("fmi3SetFloat64", "fmi3DoStep", "fmi3GetFloat64")
        )
        u_references, one, u = (c_uint32 * 1)(force), c_size_t(1), c_double()
        y_references, three, y = (c_uint32 * 3)(*outputs), c_size_t(3), self.buffer
        u_address, t, h = byref(u), c_double(), c_double(step_size)
        rollback_possible = c_bool(False)
        event, end, early, reached = c_bool(), c_bool(), c_bool(), c_double()
        report = byref(event), byref(end), byref(early), byref(reached)

        self._require_read(get_real(c, y_references, three, y, three))

        def tick(force: float, time: float) -> int:
            u.value = force
            t.value = time
            status = set_real(c, u_references, one, u_address, one)
            if status > WARNING:
                return status
            status = do_step(c, t, h, rollback_possible, *report)
            if status > WARNING:
                return status
            if end.value or early.value:  # not at the end of the step: what FMI 2 calls discard
                return DISCARD
            return get_real(c, y_references, three, y, three)

        return tick
