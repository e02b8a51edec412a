"""What the metrics of a run cost: python benchmarks/speed/bench_metrics.py.

A study makes thousands of runs, each judged by these functions; the first call compiles them and
is left out. Medians over repetitions, one thread.
"""

from __future__ import annotations

import argparse
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import (
    Anticipation,
    Critical,
    DriveSetting,
    encroachment,
    pedestrian_metrics,
    proximity,
    summarise,
)
from giveway.run_data.tracks import CrowdTrack, EgoTrack

if TYPE_CHECKING:
    from collections.abc import Callable

DT = 0.05  # [s]
BODY_RADIUS = 0.27  # [m]


def made_up_run(pedestrians: int, steps: int) -> tuple[EgoTrack, CrowdTrack]:
    """A car that slows down for a crowd crossing its way, without a simulation."""
    time = DT * np.arange(steps)
    speed = 4.0 - 3.0 * np.exp(-(((time - 5.0) / 2.0) ** 2))
    position = np.concatenate(([0.0], np.cumsum(DT * speed)[:-1]))
    ego = EgoTrack(
        time=time,
        position=position,
        front_x=2.5 + position,
        front_y=np.zeros(steps),
        heading=np.zeros(steps),
        speed=speed,
        acceleration=np.gradient(speed, DT) if steps > 1 else np.zeros(steps),
        force=np.zeros(steps),
        gap=np.full(steps, np.inf),
        reference_speed=np.full(steps, 4.0),
        vehicle_gap=np.full(steps, np.inf),
        stop_gap=np.full(steps, np.inf),
        controller=np.full(steps, "mpc"),
        reason=np.full(steps, "optimal"),
        solver_status=np.full(steps, "solved"),
        waits_for=np.full(steps, ""),
        solver_iterations=np.zeros(steps, dtype=np.int64),
    )
    rng = np.random.default_rng(1)
    start = rng.uniform((5.0, -23.0), (35.0, -3.0), (pedestrians, 2))
    velocity = np.column_stack((rng.normal(0, 0.1, pedestrians), rng.normal(1.4, 0.2, pedestrians)))
    x, y = (start + time[:, None, None] * velocity).reshape(-1, 2).T
    crowd = CrowdTrack(
        step=np.repeat(np.arange(steps), pedestrians),
        pedestrian=np.tile(np.arange(pedestrians), steps),
        x=x,
        y=y,
        vx=np.tile(velocity[:, 0], steps),
        vy=np.tile(velocity[:, 1], steps),
        ids=tuple(f"ped_{i}" for i in range(pedestrians)),
    )
    return ego, crowd


def milliseconds(call: Callable[[], object], repetitions: int) -> float:
    call()
    durations = []
    for _ in range(repetitions):
        start = perf_counter()
        call()
        durations.append(perf_counter() - start)
    return 1e3 * median(durations)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=50)
    repetitions = parser.parse_args().repetitions
    print("                       median time [ms]")
    print(f"{'pedestrians x steps':>20} {'TTC':>8} {'PET':>8} {'table':>8} {'summary':>8}")
    for pedestrians, steps in ((30, 300), (30, 1200), (300, 300)):
        ego, crowd = made_up_run(pedestrians, steps)
        judged = ego, crowd, VehicleShape(), BODY_RADIUS
        table = pedestrian_metrics(*judged)
        calls: tuple[Callable[[], object], ...] = (
            lambda judged=judged: proximity(*judged),
            lambda judged=judged: encroachment(*judged),
            lambda judged=judged: pedestrian_metrics(*judged),
            lambda ego=ego, table=table: summarise(
                ego,
                table,
                Critical(0, 0.0),
                Anticipation(),
                DriveSetting(40.0, 8.0, "mpc-paper"),
            ),
        )
        times = " ".join(f"{milliseconds(call, repetitions):8.3f}" for call in calls)
        print(f"{pedestrians:>12} x {steps:<5} {times}")


if __name__ == "__main__":
    main()
