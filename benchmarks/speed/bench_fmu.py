"""What a step of the vehicle costs: python benchmarks/speed/bench_fmu.py.

A tick is: set the force, do a step, get position, speed and acceleration. FMPy's own wrappers
against VehicleFmu, and against IsolatedVehicle, which runs the FMU in another process, on the
shipped FMUs. The variants take turns, so that a busy machine slows all
of them; medians over the rounds, and ratios within one run.
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
from itertools import pairwise
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from fmus import VehicleFmu, bundled_fmu, processes_reused
from fmus.isolation import IsolatedVehicle

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


def open_one(kind: str, version: str) -> VehicleFmu | IsolatedVehicle:
    """A vehicle that runs a shipped FMU."""
    make = VehicleFmu if kind == "in-process" else IsolatedVehicle
    return make(bundled_fmu(version), step_size=STEP)


@contextlib.contextmanager
def vehicle_ticks(kind: str, version: str) -> Iterator[Callable[[int], float]]:
    """Seconds for so many ticks through a vehicle."""
    with open_one(kind, version) as vehicle:

        def ticks(count: int) -> float:
            vehicle.start()
            step = vehicle.step
            start = perf_counter()
            for _ in range(count):
                step(FORCE)
            return perf_counter() - start

        yield ticks


def set_up(kind: str, version: str) -> tuple[float, float, float]:
    """Seconds until a vehicle has been made and started, for another start, and to close it."""
    times = [perf_counter()]
    with open_one(kind, version) as vehicle:
        vehicle.start()
        times.append(perf_counter())
        vehicle.start()
        times.append(perf_counter())
    first, again, closed = (b - a for a, b in pairwise([*times, perf_counter()]))
    return first, again, closed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=int, default=5_000, help="ticks in a round")
    parser.add_argument("--rounds", type=int, default=15)
    options = parser.parse_args()
    versions, kinds = ("2.0", "3.0"), ("FMPy", "in-process", "isolated")
    with contextlib.ExitStack() as stack:
        ticks = {
            (version, kind): stack.enter_context(
                fmpy_ticks(version) if kind == "FMPy" else vehicle_ticks(kind, version)
            )
            for version in versions
            for kind in kinds
        }
        rounds = [
            {variant: run(options.ticks) / options.ticks * 1e6 for variant, run in ticks.items()}
            for _ in range(options.rounds)
        ]
    print(f"{'a tick':10}" + "".join(f"{k:>15}" for k in (*kinds, "isolation", "/ FMPy")))
    for version in versions:
        columns = "".join(f"{median(r[version, k] for r in rounds):12.2f} us" for k in kinds)
        added = median(r[version, "isolated"] - r[version, "in-process"] for r in rounds)
        ratio = median(r[version, "isolated"] / r[version, "FMPy"] for r in rounds)
        print(f"FMI {version:6}{columns}{added:+12.2f} us{ratio:15.2f}")
    print(f"\n{'set-up':22}{'first start':>15}{'another':>15}{'close':>15}")
    for version in versions:
        for kind, block in (
            ("in-process", contextlib.nullcontext),
            ("isolated", contextlib.nullcontext),
            ("the next one", processes_reused),  # from the same watchdog, as in studies
        ):
            with block():
                set_up(kind, version)
                made = zip(*(set_up(kind, version) for _ in range(options.rounds)), strict=True)
                columns = "".join(f"{1e3 * median(times):12.2f} ms" for times in made)
            print(f"FMI {version:6}{kind:12}{columns}")


if __name__ == "__main__":
    main()
