"""What a step of the vehicle costs: python benchmarks/bench_fmu.py.

A tick is: set the force, do a step, get position, speed and acceleration. FMPy's own wrappers
against VehicleFmu, on the shipped FMUs. The variants take turns, so that a busy machine slows all
of them; medians over the rounds, and ratios within one run.
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from fmus import VehicleFmu, bundled_fmu

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

STEP = 0.05  # [s]
FORCE = 100.0  # [N]


@contextlib.contextmanager
def fmpy_ticks(version: str) -> Iterator[Callable[[int], float]]:
    """Seconds for so many ticks through FMPy's wrappers."""
    path = str(bundled_fmu(version))
    description = read_model_description(path)
    reference = {v.name: v.valueReference for v in description.modelVariables}
    force = [reference["force"]]
    outputs = [reference[name] for name in ("position", "speed", "acceleration")]
    with tempfile.TemporaryDirectory() as folder:
        slave = (FMU2Slave if version == "2.0" else FMU3Slave)(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=str(extract(path, folder)),
        )
        set_real = slave.setReal if version == "2.0" else slave.setFloat64
        get_real = slave.getReal if version == "2.0" else slave.getFloat64

        def ticks(count: int) -> float:
            slave.reset()
            if version == "2.0":
                slave.setupExperiment(startTime=0.0)
            slave.enterInitializationMode()
            slave.exitInitializationMode()
            start = perf_counter()
            for k in range(count):
                set_real(force, [FORCE])
                slave.doStep(k * STEP, STEP)
                get_real(outputs)
            return perf_counter() - start

        slave.instantiate()
        try:
            yield ticks
        finally:
            slave.freeInstance()


@contextlib.contextmanager
def vehicle_ticks(version: str) -> Iterator[Callable[[int], float]]:
    """Seconds for so many ticks through VehicleFmu."""
    with VehicleFmu(bundled_fmu(version), step_size=STEP) as vehicle:

        def ticks(count: int) -> float:
            vehicle.start()
            step = vehicle.step
            start = perf_counter()
            for _ in range(count):
                step(FORCE)
            return perf_counter() - start

        yield ticks


@contextlib.contextmanager
def set_up(version: str) -> Iterator[Callable[[int], float]]:
    """Seconds for so many vehicles made, started and closed."""

    def make(count: int) -> float:
        start = perf_counter()
        for _ in range(count):
            with VehicleFmu(bundled_fmu(version), step_size=STEP) as vehicle:
                vehicle.start()
        return perf_counter() - start

    yield make


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=int, default=5_000, help="ticks in a round")
    parser.add_argument("--rounds", type=int, default=15)
    options = parser.parse_args()
    versions = ("2.0", "3.0")
    kinds = {"FMPy": fmpy_ticks, "VehicleFmu": vehicle_ticks}
    with contextlib.ExitStack() as stack:
        ticks = {
            (version, kind): stack.enter_context(make(version))
            for version in versions
            for kind, make in kinds.items()
        }
        makers = {version: stack.enter_context(set_up(version)) for version in versions}
        rounds = [
            {variant: run(options.ticks) / options.ticks * 1e6 for variant, run in ticks.items()}
            for _ in range(options.rounds)
        ]
        made = {version: make(20) / 20 * 1e3 for version, make in makers.items()}
    print(f"{'':8}{'FMPy':>12}{'VehicleFmu':>14}{'ratio':>8}{'set up':>12}")
    for version in versions:
        bare, ours = (median(r[version, kind] for r in rounds) for kind in kinds)
        ratio = median(r[version, "FMPy"] / r[version, "VehicleFmu"] for r in rounds)
        print(f"FMI {version:4}{bare:9.2f} us{ours:11.2f} us{ratio:7.1f}x{made[version]:9.2f} ms")


if __name__ == "__main__":
    main()
