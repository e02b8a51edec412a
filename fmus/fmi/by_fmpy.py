"""A drive of an FMU by FMPy's own simulation, for comparison."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import fmpy
import numpy as np
from numpy.typing import NDArray

from fmus.description.model import Interface, Kind, Value
from fmus.profile.tables import Stepping

VERSION = str(fmpy.__version__)


def simulate(
    path: Path,
    interface: Interface,
    stepping: Stepping,
    start_values: Mapping[str, Value],
    inputs: Mapping[str, NDArray[np.float64]],
    outputs: Sequence[str],
    step: float,
) -> NDArray[np.float64]:
    """Return the outputs (n + 1, k) at the ends of n steps, and before the first.

    Args:
        path: Path of the FMU.
        interface: Interface that is run.
        stepping: Settings of the solver.
        start_values: Start values by name.
        inputs: Values (n,) that each input has over each step, by name.
        outputs: Names of the k outputs.
        step: Step of the FMU [s].
    """
    count = len(next(iter(inputs.values())))
    first = stepping.start_time
    time = first + np.arange(count + 1) * step
    held = {name: np.append(values, values[-1]) for name, values in inputs.items()}
    if interface.kind is Kind.MODEL_EXCHANGE:  # its inputs would change linearly within a step
        time = np.repeat(time, 2)[1:]
        held = {name: np.repeat(values, 2)[:-1] for name, values in held.items()}
    signals = np.array(
        list(zip(time, *held.values(), strict=True)),
        dtype=[("time", float), *((name, float) for name in held)],
    )
    found = fmpy.simulate_fmu(
        str(path),
        validate=False,
        fmi_type="ModelExchange" if interface.kind is Kind.MODEL_EXCHANGE else "CoSimulation",
        solver="CVode",
        relative_tolerance=stepping.tolerance,
        start_values=dict(start_values),
        input=signals,
        output=list(outputs),
        output_interval=step,
        start_time=first,
        stop_time=first + count * step,
        set_stop_time=False,
    )
    at = np.searchsorted(found["time"] - first, (np.arange(count + 1) + 1e-6) * step) - 1
    return np.stack([np.asarray(found[name], float)[at] for name in outputs], axis=1)
