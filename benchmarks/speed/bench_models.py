"""The cost of one step of 0.05 s by each model of people, one vehicle among them.

Run: python benchmarks/speed/bench_models.py [--people 10 30 100] [--steps 100] [--prediction]

Processor time, the least of five rounds; JuPedSim's models where it is installed. ``--prediction``
prints the cost of one prediction of 2.5 s instead, by VCI and by drift, with drift's memory.
"""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from time import process_time

import numpy as np

from giveway.config import RunConfig
from giveway.crowd.models import model_of
from giveway.crowd.roster import Roster
from pedestrian_model import (
    JUPEDSIM_MODELS,
    PLAIN_MODELS,
    SIM,
    Crowd,
    PedestrianModel,
    Predictor,
    Vehicles,
    unmoved,
)
from pedestrian_model.drift.predictor import DriftPredictor

TIME_STEP = 0.05  # [s]
STEP, STEPS = 0.1, 25  # Step [s] of a prediction, and their number
ROUNDS = 5


def scene(n: int) -> tuple[Crowd, Vehicles]:
    """People at one in 4 m^2 who cross each other's ways, and a car that drives through."""
    g, side = np.random.default_rng(n), 2.0 * np.sqrt(n)
    place = g.uniform(-0.5 * side, 0.5 * side, (n, 2))
    crowd = Crowd.create(place, np.zeros((n, 2)), 1.3, [[-point] for point in place])
    return crowd, Vehicles.create([-6.0], [0.0], [0.0], [1.0])


def cost(model: PedestrianModel, n: int, steps: int) -> float:
    """Microseconds of a step of n people."""
    least = np.inf
    for _ in range(ROUNDS):
        crowd, vehicles = scene(n)
        model.advance(crowd, vehicles)
        began = process_time()
        for _ in range(steps):
            model.advance(crowd, vehicles)
        least = min(least, (process_time() - began) / steps)
    return 1e6 * least


def prediction_cost(believed: str, n: int, steps: int) -> float:
    """Microseconds of a prediction of n people."""
    crowd, vehicles = scene(n)
    crowd.velocity[:] = np.random.default_rng(n).normal(0.0, 1.0, (n, 2))
    poses, ids = np.repeat(vehicles.array[None], STEPS, axis=0), np.arange(n)
    drift = DriftPredictor(unmoved(SIM), STEP, STEPS, interval=TIME_STEP)
    predictor = drift if believed == "drift" else Predictor(SIM, STEP, STEPS, longest_step=STEP)
    for _ in range(round(3.0 / TIME_STEP)):
        drift.remember(crowd, ids)
    least = np.inf
    for _ in range(ROUNDS):
        predictor.predict(crowd, poses)
        began = process_time()
        for _ in range(steps):
            if predictor is drift:
                drift.remember(crowd, ids)
            predictor.predict(crowd, poses)
        least = min(least, (process_time() - began) / steps)
    return 1e6 * least


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, nargs="+", default=[10, 30, 100])
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--prediction", action="store_true", help="predictions instead of steps")
    options = parser.parse_args()
    if options.prediction:
        print(
            f"{'us for a prediction of 2.5 s of':34}" + "".join(f"{n:8d}" for n in options.people)
        )
        for name in ("vci", "drift"):
            costs = [prediction_cost(name, n, options.steps) for n in options.people]
            print(f"{name:34}" + "".join(f"{value:8.0f}" for value in costs), flush=True)
        return
    names = ["vci", *PLAIN_MODELS, *(JUPEDSIM_MODELS if find_spec("jupedsim") else ())]
    print(f"{'us for a step of':34}" + "".join(f"{n:8d}" for n in options.people))
    for name in names:
        config = RunConfig.model_validate({"crowd": {"model": name}})
        costs = []
        for n in options.people:
            crowd, _ = scene(n)
            roster = Roster([f"ped{i}" for i in range(n)], crowd)
            costs.append(cost(model_of(config, TIME_STEP, roster), n, options.steps))
        print(f"{name:34}" + "".join(f"{value:8.0f}" for value in costs), flush=True)


if __name__ == "__main__":
    main()
