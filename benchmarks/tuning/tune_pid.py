"""How pid-tuned came to its numbers: python benchmarks/tuning/tune_pid.py.

It prints the gains' candidates, the best first; a dash at the end marks those that break a
constraint. Then it prints how reference profiles approach a person who stands. What profiles give
in crowds is the study ``profiles`` of ``python benchmarks/evidence pid``.
"""

from __future__ import annotations

import argparse

import numpy as np
from pid_tuning import table, tune

from controller import LongitudinalModel, ReferenceParameters, TunedPid, TunedPidParameters


def approach(profile: str, deceleration: float) -> tuple[float, ...]:
    """From 4 m/s and 40 m to somebody who stands: time until 0.2 m/s, gap, braking, RMS jerk."""
    reference = ReferenceParameters(profile=profile, deceleration=deceleration)
    model, (x, v), speeds = LongitudinalModel(), (0.0, 4.0), []
    pid = TunedPid(TunedPidParameters(reference=reference), model)
    for _ in range(1200):
        u = pid.control(v, 40.0 - x)
        x += model.time_step * v
        v = max(0.0, model.decay * v + model.speed_per_force * u)
        speeds.append(v)
    slowed = model.time_step * float(np.argmax(np.array(speeds) < 0.2))
    braking = -np.diff(speeds) / model.time_step
    jerk = np.diff(braking) / model.time_step
    return slowed, 40.0 - x, braking.max(), float(np.sqrt(np.mean(jerk[:400] ** 2)))


def print_approaches() -> None:
    print(
        f"\n{'to somebody who stands':24}{'T [s]':>8}{'gap [m]':>9}{'braking':>9}{'RMS jerk':>10}"
    )
    for profile, b in (("linear", 1.0), *(("braking-curve", b) for b in (0.5, 1.0, 2.0, 3.0))):
        time, gap, braking, jerk = approach(profile, b)
        name = profile if profile == "linear" else f"{profile}, b {b:g}"
        print(f"{name:24}{time:8.2f}{gap:9.2f}{braking:9.2f}{jerk:10.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=12, help="candidates of the gains to print")
    options = parser.parse_args()
    found = tune(LongitudinalModel())
    print(table(found[: options.rows]))
    print_approaches()


if __name__ == "__main__":
    main()
