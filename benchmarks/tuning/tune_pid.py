"""How pid-tuned came to its numbers: python benchmarks/tuning/tune_pid.py [--crowds SEEDS].

Prints the gains' candidates, the best first; those that break a constraint have a dash at the end.
With ``--crowds`` also what reference profiles and comforts give in the closed loop of SUMO and the
FMU, on the same crowds: the cost is the completion time plus one second for each m/s^3 of RMS jerk.
"""

from __future__ import annotations

import argparse
import multiprocessing

import numpy as np
from pid_tuning import table, tune

import giveway
from controller import LongitudinalModel, ReferenceParameters, TunedPid, TunedPidParameters

CROWDS = {
    "shared_space": {"crowd": {"pedestrians": 30}},
    "two-sided": {"crowd": {"pedestrians": 30, "two_sided": True}},
    "street": {"scenario": "street", "crowd": {"pedestrians": 30}},
}
CANDIDATES = {  # profile, b [m/s^2], j [m/s^3], a [m/s^2], d_last [m]
    "curve, b 1": ("braking-curve", 1.0, 10.0, 3.0, 2.0),
    "curve, b 2": ("braking-curve", 2.0, 10.0, 3.0, 2.0),
    "curve, b 3": ("braking-curve", 3.0, 10.0, 3.0, 2.0),
    "linear, b 2": ("linear", 2.0, 10.0, 3.0, 2.0),
    "j 5": ("braking-curve", 2.0, 5.0, 3.0, 2.0),
    "j 20": ("braking-curve", 2.0, 20.0, 3.0, 2.0),
    "a 2": ("braking-curve", 2.0, 10.0, 2.0, 2.0),
    "a 4": ("braking-curve", 2.0, 10.0, 4.0, 2.0),
    "d_last 4": ("braking-curve", 2.0, 10.0, 3.0, 4.0),
}
COLUMNS = {
    "completion_time": "T [s]",
    "longest_wait": "wait [s]",
    "rms_jerk": "RMS jerk",
    "peak_deceleration": "braking",
    "share_below_safe_distance": "< d_safe",
    "overlaps": "overlaps",
}
JERK_PRICE = 1.0  # [s per m/s^3]


def measure(settings: dict) -> list[float]:
    """The columns of one run."""
    summary = giveway.run(settings).summary
    row = summary if isinstance(summary, dict) else summary.iloc[0]
    return [float(row[name]) for name in COLUMNS]


def candidates() -> dict[str, dict]:
    """The settings that are compared; the paper's controllers as landmarks."""
    keys = ("profile", "deceleration", "jerk", "acceleration", "last_distance")
    compared: dict[str, dict] = {name: {"controller": name} for name in ("pid-paper", "mpc-paper")}
    for name, values in CANDIDATES.items():
        tuned = dict(zip(keys, values, strict=True))
        compared[name] = {"controller": "pid-tuned", "controller_options": tuned}
    return compared


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


def compare(crowd: dict, seeds: int, pool: multiprocessing.pool.Pool) -> None:
    """One line per candidate; without the safety layer, which would brake for all alike."""
    print(f"{'':12}" + "".join(f"{title:>10}" for title in COLUMNS.values()) + f"{'cost':>10}")
    for name, settings in candidates().items():
        base = {**crowd, **settings, "safety": {"enabled": False}}
        rows = pool.map(measure, [{**base, "seed": seed} for seed in range(1, seeds + 1)], 5)
        found = np.array(rows)
        means = np.append(found[:, :-1].mean(axis=0), found[:, -1].sum())
        cost = means[0] + JERK_PRICE * means[2]
        print(f"{name:12}" + "".join(f"{value:10.3f}" for value in (*means, cost)), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=12, help="candidates of the gains to print")
    parser.add_argument("--crowds", type=int, default=0, metavar="SEEDS")
    parser.add_argument("--only", choices=CROWDS, nargs="+", default=list(CROWDS))
    options = parser.parse_args()
    found = tune(LongitudinalModel())
    print(table(found[: options.rows]))
    print_approaches()
    if options.crowds:
        with multiprocessing.get_context("spawn").Pool() as pool:
            for name in options.only:
                print(f"\n{name}, 30 pedestrians, seeds 1 to {options.crowds}")
                compare(CROWDS[name], options.crowds, pool)


if __name__ == "__main__":
    main()
