"""The cost of the whole loop at 30 pedestrians, part by part, next to SUMO and the FMU alone.

Run: python benchmarks/bench_loop.py [--pairs N] [--controller NAME] [--perception-model NAME]

The baseline makes the same moves, SUMO steps and FMU steps as a recorded run, with nothing in
between. Both are timed in turn in one process; the ratio is what counts.
"""

from __future__ import annotations

import argparse
import statistics
from contextlib import ExitStack
from time import perf_counter, process_time

import numpy as np

from giveway.api import RunResult, simulate
from giveway.config.layers import Layer
from giveway.config.loading import load
from giveway.cosimulation.assembly import assemble
from giveway.cosimulation.preflight import preflight
from giveway.geometry.path import headings_to_angles
from giveway.records.tracks import Timings

CONTROLLERS = ("mpc", "pid-tuned", "mpc-paper", "pid-paper")


def baseline(result: RunResult) -> float:
    """Seconds that the moves, SUMO's steps and the FMU's steps of ``result`` take alone."""
    import libsumo

    ego, crowd = result.ego_track, result.crowd_track
    angle = headings_to_angles(np.arctan2(crowd.vy, crowd.vx))
    everybody = np.column_stack([crowd.x, crowd.y, angle])
    bounds = np.searchsorted(crowd.step, np.arange(len(ego.time) + 1))
    steps = [
        (
            (float(ego.front_x[k]), float(ego.front_y[k])),
            [crowd.ids[i] for i in crowd.pedestrian[bounds[k] : bounds[k + 1]]],
            everybody[bounds[k] : bounds[k + 1]].tolist(),
            float(ego.force[k - 1]),
        )
        for k in range(1, len(ego.time))
    ]
    with ExitStack() as stack:
        parts = assemble(preflight(result.config, result.scenario), stack)
        vehicle = parts.egos[0].vehicle
        parts.departures.due()  # inserts the ego and starts its FMU
        move_ego, move_person = libsumo.vehicle.moveToXY, libsumo.person.moveToXY
        began = perf_counter()
        for (x, y), ids, rows, force in steps:
            vehicle.step(force)
            move_ego("ego", "", -1, x, y, 90.0, 2)
            for name, (p_x, p_y, p_angle) in zip(ids, rows, strict=True):
                move_person(name, "", p_x, p_y, p_angle, 2, -1.0)
            libsumo.simulationStep()
        return perf_counter() - began


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=4, help="4 meets the crowd and keeps moving")
    parser.add_argument("--pairs", type=int, default=15, help="loop and baseline, in turn")
    parser.add_argument("--controller", action="append", choices=CONTROLLERS, help="these only")
    parser.add_argument("--perception-model", default="vci", help="that is believed in")
    options = parser.parse_args()
    for controller in options.controller or CONTROLLERS:
        settings = {
            "controller": controller,
            "seed": options.seed,
            "perception": {"model": options.perception_model},
        }
        checked = preflight(*load([Layer("", settings)]))
        simulate(checked)  # compiles, and warms the file cache
        results, ratios, busy = [], [], []
        for _ in range(options.pairs):
            began = process_time()
            result = simulate(checked)
            busy.append(process_time() - began)
            results.append(result)
            ratios.append(result.elapsed / baseline(result))
        elapsed = statistics.median(r.elapsed for r in results)
        steps = len(results[0].ego_track.time) - 1
        seconds = float(results[0].time[-1] - results[0].time[0])
        factor = seconds / elapsed
        print(f"{controller}, 30 pedestrians, {steps} steps of {seconds / steps:.2f} s")
        print(f"  loop / (SUMO moves and steps + FMU steps): {statistics.median(ratios):.2f}")
        print(f"  per step: {elapsed / steps * 1e6:.0f} us; real-time factor {factor:.0f}")
        print(f"  of which the processor is busy at least {min(busy) / steps * 1e6:.0f} us")
        for name in Timings.NAMES[:-1]:
            share = statistics.median(r.timing_summary["shares"][name] for r in results)
            print(f"  {name:10} {100 * share:5.1f} %")


if __name__ == "__main__":
    main()
