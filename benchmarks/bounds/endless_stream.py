"""Drives through people who cross 18 m of the way and do not end.

Run: python benchmarks/bounds/endless_stream.py [--controller mpc] [--seeds 3]
"""

from __future__ import annotations

import argparse

import giveway

RATES = 6000, 12000  # persons per hour
FROM, TO = [[19.0, -15.0], [37.0, -15.0]], [[19.0, 15.0], [37.0, 15.0]]  # lines [m]


def drive(controller: str, preset: str, rate: int, seed: int) -> giveway.RunResult:
    """One drive, of 120 s at most, through a stream that began 40 s before."""
    stream = {"rate": rate, "begin": -40.0, "from": FROM, "to": TO}
    return giveway.run(
        {
            "scenario": "shared_space",
            "controller": controller,
            "seed": seed,
            "time_limit": 120.0,
            "crowd": {"preset": preset, "pedestrians": 0, "flow": [stream]},
        }
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--seeds", type=int, default=3)
    chosen = parser.parse_args()
    print(
        "| people | persons/h | time of each drive [s] | close passes | of people near | touched |"
    )
    print("|---|---|---|---|---|---|")
    for preset in ("MIXED", "SIM"):
        for rate in RATES:
            drives = [
                drive(chosen.controller, preset, rate, seed).summary
                for seed in range(1, 1 + chosen.seeds)
            ]
            times = ", ".join(f"{each['completion_time']:.0f}" for each in drives)
            close, near, side, frontal = (
                sum(each[name] for each in drives)
                for name in ("close_passes", "people_near", "side_contacts", "frontal_contacts")
            )
            print(f"| {preset} | {rate} | {times} | {close} | {near} | {side + frontal} |")


if __name__ == "__main__":
    main()
