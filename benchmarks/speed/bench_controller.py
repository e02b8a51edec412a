"""What a decision of the exported controller costs: python benchmarks/speed/bench_controller.py.

A car among walkers who step into its way and leave it, driven by the controller FMU through FMPy's
own wrappers: set the inputs, read the force, do a step. Next to it giveway's own controller decides
the same, in Python with OSQP; the two forces are compared.
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave

from controller import Observation
from fmus.sources.export import export_controller
from fmus.sources.parameters import ControllerParameters
from giveway.config import EgoRunConfig
from giveway.ego.controllers import make_controller

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

FAR = 1e9  # [m] nobody in front


@contextlib.contextmanager
def exported(p: ControllerParameters) -> Iterator[Callable[[Observation, int], float]]:
    """The controller FMU for FMI 3.0: an observation and the number of the step, a force [N]."""
    with tempfile.TemporaryDirectory() as folder:
        path = export_controller(Path(folder, "controller.fmu"), p, fmi_version="3.0")
        description = read_model_description(str(path))
        reference = {v.name: v.valueReference for v in description.modelVariables}
        slave = FMU3Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=str(extract(str(path), folder)),
        )
        names = ("speed", "position", "gap", "speed_limit", "obstacle_position")
        inputs, force = [reference[name] for name in names], [reference["force"]]
        slave.instantiate()
        slave.enterInitializationMode()
        slave.exitInitializationMode()

        def decide(seen: Observation, k: int) -> float:
            values = [seen.speed, seen.position, min(seen.gap, FAR), FAR]
            slave.setFloat64(inputs, [*values, *np.minimum(seen.obstacle_positions, FAR)])
            (found,) = slave.getFloat64(force)
            slave.doStep(k * p.time_step, p.time_step)
            return float(found)

        try:
            yield decide
        finally:
            slave.terminate()
            slave.freeInstance()


def compare(horizon: int, decisions: int, seed: int) -> tuple[np.ndarray, float]:
    """(n, 2) seconds of the FMU and of our controller, and how far their forces differ [N]."""
    p, random = ControllerParameters(horizon=horizon), np.random.default_rng(seed)
    h = p.time_step
    settings = {"controller": "mpc-paper", "controller_options": {"horizon": horizon}}
    own = make_controller(EgoRunConfig.model_validate(settings), h)
    ahead = h * np.arange(1, horizon + 1)
    position, speed, apart = 0.0, 4.0, 0.0
    walker, walks, present = 30.0, 0.0, True
    costs = np.empty((decisions, 2))
    with exported(p) as decide:
        for k in range(decisions):
            if random.random() < 0.05:
                present, walks = not present, random.normal(0.0, 1.5)
                walker = position + random.uniform(5.0, 25.0)
            predicted = walker + walks * ahead if present else np.full(horizon, np.inf)
            gap = walker - position if present else np.inf
            seen = Observation(position, speed, gap, predicted, np.inf)
            begin = perf_counter()
            force = decide(seen, k)
            between = perf_counter()
            same = own.control(seen).force
            costs[k] = between - begin, perf_counter() - between
            apart = max(apart, abs(force - same))
            position += h * speed
            speed = max(0.0, speed + h / p.mass * (force - p.friction * speed))
            walker += h * walks
    return costs[decisions // 10 :], apart


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--decisions", type=int, default=5_000)
    parser.add_argument("--horizons", type=int, nargs="+", default=[15, 50, 200])
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    title = f"{'a decision [us]':>16}{'FMU: median':>14}{'99 %':>9}{'ours: median':>20}{'99 %':>9}"
    print(f"{title}{'apart [N]':>12}")
    for horizon in options.horizons:
        costs, apart = compare(horizon, options.decisions, options.seed)
        median, late = 1e6 * np.quantile(costs, [0.5, 0.99], axis=0)
        columns = f"{median[0]:14.1f}{late[0]:9.0f}{median[1]:20.1f}{late[1]:9.0f}{apart:12.1e}"
        print(f"N = {horizon:<12}{columns}")


if __name__ == "__main__":
    main()
