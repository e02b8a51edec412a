"""The loading and calling of FMUs; only this package uses FMPy.

Instances call the FMU's C functions themselves, without FMPy's wrappers. A step takes as long as in
C, and a missing function is an error only where it is needed.
"""

from __future__ import annotations

from pathlib import Path

from fmus.description.model import Interface, Kind, Model
from fmus.errors import FmuInterfaceError
from fmus.fmi.calls import Calls
from fmus.fmi.co_simulation import CoSimulation
from fmus.fmi.fmi1 import Fmi1Calls
from fmus.fmi.fmi2 import Fmi2Calls
from fmus.fmi.fmi3 import Fmi3Calls
from fmus.fmi.library import Library
from fmus.fmi.messages import MessageLog
from fmus.fmi.running import Instance
from fmus.profile.clocks import Ticking
from fmus.profile.tables import Stepping

__all__ = ["load"]

_CALLS: dict[str, type[Calls]] = {"1.0": Fmi1Calls, "2.0": Fmi2Calls, "3.0": Fmi3Calls}


def load(
    model: Model,
    interface: Interface,
    folder: Path,
    binary: str,
    stepping: Stepping,
    *,
    rewinds: bool = True,
    clocks: tuple[Ticking, ...] = (),
) -> Instance:
    """Load an FMU's library, ready to be started.

    Args:
        model: Model description of the FMU.
        interface: Interface that is to run.
        folder: Folder with the extracted FMU; the caller removes it after :meth:`Instance.close`.
        binary: Library for this platform, by its name in the archive.
        stepping: Settings of the profile: the solver of Model Exchange, its tolerance (or that of
            the FMU in Co-Simulation), and the first and last time that the FMU is given.
        rewinds: True to keep the state before each step, so that a discarded step can be repeated
            in smaller ones. It works only with Co-Simulation FMUs that can save their state.
        clocks: Input clocks that tick.

    Raises:
        FmuInterfaceError: this version and kind cannot be run.
        FmuPlatformError: the binary cannot be loaded, or lacks a function that it must have.
    """
    if model.fmi_version not in _CALLS:
        raise FmuInterfaceError(
            f"{model.path}: FMI {model.fmi_version}; expected 1.0, 2.0 or 3.0; export it again"
        )
    (folder / "resources").mkdir(exist_ok=True)  # its path is given to the FMU even if it is empty
    library = Library(folder / binary, model.path, folder)
    try:
        calls = _CALLS[model.fmi_version](library, model, interface, folder, MessageLog())
        calls.start_time, calls.stop_time = stepping.start_time, stepping.stop_time
        if interface.kind == Kind.MODEL_EXCHANGE:
            from fmus.fmi.model_exchange import ModelExchange  # Co-Simulation needs no numpy

            instance: Instance = ModelExchange(calls, stepping.tolerance, stepping.solver)
        else:
            instance = CoSimulation(calls, stepping.tolerance, rewinds=rewinds)
        instance.tickings = clocks
        return instance
    except BaseException:
        library.close()
        raise
