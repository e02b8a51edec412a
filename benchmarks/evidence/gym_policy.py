"""A hand-written policy in giveway.gym.DriveEnv among giveway's own drivers, and how fast it steps.

Run: python benchmarks/evidence/gym_policy.py              # 20 crowds: the table of docs/gym.md
     python benchmarks/evidence/gym_policy.py --seeds 5
"""

from __future__ import annotations

import argparse
import statistics
import time
from typing import Any

import numpy as np

import giveway
from giveway.gym import DriveEnv

SETTINGS: dict[str, Any] = {"scenario": "encounter"}
SHOWN = {
    "completion_time": "time [s]",
    "longest_wait": "longest wait [s]",
    "rms_jerk": "RMS jerk [m/s^3]",
    "people_below_ttc": "people below 1.5 s",
    "frontal_contacts": "frontal contacts",
}


def policy(seen: dict[str, Any]) -> np.ndarray:
    """Keep 4 m/s, and 1.5 s from whoever is ahead and walks towards the way, or is on it."""
    speed = float(seen["ego"][0])
    x, y, _, across, there = seen["people"].T
    comes = (np.abs(y) < 1.6) | (np.abs(y + 2.0 * across) < 1.6)
    ahead = x[(there > 0.0) & (x > 0.0) & comes]
    gap = min(float(ahead.min(initial=np.inf)), float(seen["ahead"][1])) - 2.0
    wanted = min(4.0, float(seen["ahead"][0]), max(gap, 0.0) / 1.5)
    return np.array([np.clip((wanted - speed) / 5.0, -1.0, 0.3)], dtype=np.float32)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    seeds = range(1, parser.parse_args().seeds + 1)
    rows: dict[str, list[dict[str, Any]]] = {"the policy above": []}
    env = DriveEnv(SETTINGS)
    steps, stepping, resetting = 0, 0.0, 0.0
    env.reset(seed=0)  # compiles
    for seed in seeds:
        began = time.perf_counter()
        seen, _ = env.reset(seed=seed)
        begun = time.perf_counter()
        over = False
        while not over:
            seen, _, terminated, truncated, told = env.step(policy(seen))
            over = terminated or truncated
            steps += 1
        resetting += begun - began
        stepping += time.perf_counter() - begun
        rows["the policy above"].append(told["summary"])
    env.close()
    for name in ("pid-tuned", "mpc"):
        settings = SETTINGS | {"controller": name, "safety": {"enabled": False}}
        rows[f"`{name}`"] = [dict(giveway.run(settings | {"seed": s}).summary) for s in seeds]
    print("| driver | " + " | ".join(SHOWN.values()) + " |")
    print("|" + "---|" * (len(SHOWN) + 1))
    for name, summaries in rows.items():
        means = [statistics.fmean(float(one[key] or 0.0) for one in summaries) for key in SHOWN]
        print(f"| {name} | " + " | ".join(f"{mean:.1f}" for mean in means) + " |")
    print(f"\n{steps / stepping:,.0f} steps/s; {1e3 * resetting / len(seeds):.0f} ms for a reset")


if __name__ == "__main__":
    main()
