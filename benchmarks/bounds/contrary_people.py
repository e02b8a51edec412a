"""Drives at people who do not do what the model of people says: they stand, stop, or turn back.

Run: python benchmarks/bounds/contrary_people.py [--controller mpc] [--no-safety]

One person is alone on the way of `shared_space`, 60 m ahead, seen all the time:

* ``stands`` in the middle of the way from the beginning;
* ``stands beside`` the way, 0.3 to 0.4 m from the body;
* ``walks along`` the way, away from the ego, at 1.3 m/s;
* ``stops`` in the middle of the way when the ego is 1.5 s away, and stays;
* ``turns back`` behind the middle when the ego is 1.5 s away.

The last two are tried with five starting places 0.2 s apart, and the hardest case is printed.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

import giveway
from pedestrian_model import Accelerations, ModelSetup, Walkers

SPEEDS = 4.0, 8.0, 13.9  # reference speeds of the ego [m/s]
PLACE, PACE, SIDE = 60.0, 1.34, 1.97  # station, speed and side [m, m/s, m] of the person at first
AWAY, REACH = 1.5, 1.0  # time [s] and lateral distance [m] at which the person acts
ABLE, ALONG = 3.0, 1.3  # acceleration [m/s^2] of the person, and walking speed [m/s] along the way
LATER = (-0.4, -0.2, 0.0, 0.2, 0.4)  # changes of the person's arrival [s]


@dataclass(frozen=True)
class Options:
    """The options of the model."""

    does: str = "stands"


class ContraryPerson:
    """A person who stands, walks along the way, stops on it or turns back on it.

    Args:
        setup: What giveway tells a model of people.
        options: What the person does.
    """

    Options = Options

    def __init__(self, setup: ModelSetup, options: Options) -> None:
        self._time_step, self._does = setup.time_step, options.does
        self.reset()

    def reset(self) -> None:
        """Forget that the person acted."""
        self._acts = False

    def step(self, walkers: Walkers) -> Accelerations:
        """Return the acceleration [m/s^2] towards the velocity that the person wants."""
        wanted = np.array(walkers.preferred)
        if self._does in {"stops", "turns back"}:
            self._acts |= any(self._near(walkers, vehicle) for vehicle in walkers.vehicles)
            if self._acts:
                wanted *= 0.0 if self._does == "stops" else -1.0
        elif self._does == "walks along":
            wanted[:] = ALONG, 0.0
        else:
            wanted[:] = 0.0
        change = (wanted - walkers.velocity) / self._time_step
        size = np.maximum(np.hypot(change[:, 0], change[:, 1]), ABLE)
        return Accelerations(change * (ABLE / size)[:, None])

    def _near(self, walkers: Walkers, vehicle: tuple[float, ...]) -> bool:
        """Whether the person is where they act, before this vehicle."""
        x, y, _, speed, front, _, _ = vehicle
        (p_x, p_y), (_, towards) = walkers.position[0], walkers.preferred[0]
        beyond = (p_y - y) * np.sign(towards)
        there = beyond > 0.3 if self._does == "turns back" else abs(p_y - y) < REACH
        return bool(there and beyond < 2.2 and 0.0 < p_x - x - front < AWAY * max(speed, 0.3))


def drive(
    controller: str, speed: float, does: str, later: float, safety: bool
) -> giveway.RunResult:
    """One drive at the person."""
    crosses = does in {"stops", "turns back"}
    away = PACE * (PLACE / speed + later) if crosses else SIDE if does == "stands beside" else 0.0
    return giveway.run(
        {
            "scenario": "shared_space",
            "controller": controller,
            "time_limit": 60.0,
            "safety": {"enabled": safety},
            "regulation": {"reference_speed": speed},
            "ego": {"travel_distance": 90.0, "initial_speed": speed},
            "model_options": {"does": does},
            "crowd": {
                "pedestrians": 1,
                "model": "contrary_people:ContraryPerson",
                "spawn_area": [PLACE, -away, PLACE + 0.02, 0.02 - away],
                "walk": [0.0, 2.0 * away + 10.0],
            },
        }
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--no-safety", action="store_true")
    chosen = parser.parse_args()
    print("| the person | v_r [m/s] | hardest braking [m/s²] | least clearance [m] | ", end="")
    print("arrived | longest wait [s] | frontal contacts |\n|---|---|---|---|---|---|---|")
    for does in ("stands", "stands beside", "walks along", "stops", "turns back"):
        for speed in SPEEDS:
            places = LATER if does in {"stops", "turns back"} else (0.0,)
            drives = [
                drive(chosen.controller, speed, does, later, not chosen.no_safety).summary
                for later in places
            ]
            hardest = max(each["peak_deceleration"] for each in drives)
            clearance = min(each["minimum_clearance"] for each in drives)
            arrived = sum(bool(np.isfinite(each["completion_time"])) for each in drives)
            waited = max(each["longest_wait"] for each in drives)
            hit = sum(each["frontal_contacts"] for each in drives)
            print(
                f"| {does} | {speed:g} | {hardest:.1f} | {clearance:.2f} | "
                f"{arrived} of {len(drives)} | {waited:.0f} | {hit} |"
            )


if __name__ == "__main__":
    main()
