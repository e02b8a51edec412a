"""Measures whether `identify` finds what drawn vehicles and FMUs of known truth are.

Run: python benchmarks/bounds/identified_plants.py --out FILE.csv [--variants 200] [--first 1]
     [--folder FOLDER --truth FILE.toml]

A variant is a vehicle with drawn mass, resistance, lags, dead times, limits, sensors, gears and
pedals, integrated with steps of 1 ms. FOLDER holds FMUs; the truth is a table for each, with the
keys of a row, and `profile` with the name of its profile in FOLDER/profiles. FILE.csv holds a row
per vehicle, so that the command can be ended and resumed; the sums are printed of all rows.
"""

from __future__ import annotations

import argparse
import csv
import math
import time
import tomllib
from pathlib import Path
from typing import Any

import numba
import numpy as np

from fmus.checking import Identification, Mpc, identify, opener_of, without_guards
from fmus.errors import FmuError
from fmus.profile.preparation import choose_profile
from fmus.profile.vehicle_profile import VehicleProfile, make_profile, read_profile

STEP, FINE = 0.05, 1e-3  # steps [s] of the controller and of the vehicle
MASS, LATE, LIMIT = 0.03, 0.05, 0.05  # tolerances: share of M, [s] of lag and dead time, share
NAMES = (
    "mass", "constant", "viscous", "quadratic", "drive_lag", "drive_lag2", "drive_delay",
    "drive_release", "drive_limit", "drive_rate", "power", "brake_lag", "brake_delay",
    "brake_release", "brake_limit", "brake_rate", "frequency", "damping", "gap", "gap_speed",
    "gap_speed2", "sensor", "exponent", "noise", "exact_position",
)  # fmt: skip
AT = {name: index for index, name in enumerate(NAMES)}
LIMITS = ("drive_limit", "power", "drive_rate", "brake_limit", "brake_rate")
SIDES = ("drive", "brake")
TOLD = ("mass", "late", "limit", "power", "rate")
FIELDS = [
    "name", "traits", "seconds", "outcome",
    *(f"{side}_{what}" for side in SIDES for what in ("mass_error", "late_error", "covered")),
    "wrong",
]  # fmt: skip
_BUFFER = 2048  # number of fine steps that a dead time may have


@numba.njit(cache=True)
def _advance(p, s, late, drive, brake, steps):  # type: ignore[no-untyped-def]  # pragma: no cover
    """Integrate the vehicle; s is its state."""
    (mass, c0, c1, c2, lag, lag2, _delay, release, limit, rate, power, brake_lag, _brake_delay,
     brake_release, brake_limit, brake_rate, frequency, damping, gap, v1, v2, sensor, _exponent,
     _noise, _exact) = p  # fmt: skip
    h = 1e-3
    for _ in range(steps):
        k = int(s[11]) % late.shape[1]
        late[0, k], late[1, k] = drive, brake
        wanted = late[0, (k - round(p[6] / h)) % late.shape[1]]
        braked = late[1, (k - round(p[12] / h)) % late.shape[1]]
        wanted = min(wanted, limit, power / max(s[1], 0.1))
        braked = min(braked, brake_limit)
        s[2] += min(max(wanted - s[2], -rate * h), rate * h)
        s[3] += min(max(braked - s[3], -brake_rate * h), brake_rate * h)
        one = s[2] if s[8] <= 0.0 else 0.0
        s[9] += (one - s[9]) * (1.0 - math.exp(-h / lag2)) if lag2 > 0.0 else one - s[9]
        tau = lag if s[9] > s[4] or release <= 0.0 else release
        s[4] += (s[9] - s[4]) * (1.0 - math.exp(-h / tau)) if tau > 0.0 else s[9] - s[4]
        tau = brake_lag if s[3] > s[5] or brake_release <= 0.0 else brake_release
        s[5] += (s[3] - s[5]) * (1.0 - math.exp(-h / tau)) if tau > 0.0 else s[3] - s[5]
        force = s[4] - s[5]
        if frequency > 0.0:
            w = 2.0 * math.pi * frequency
            s[7] += h * (w * w * (force - s[6]) - 2.0 * damping * w * s[7])
            s[6] += h * s[7]
            force = s[6]
        v = s[1]
        resistance = c0 + c1 * v + c2 * v * v
        held = resistance if v > 0.0 else min(resistance, max(force, 0.0))
        after = max(v + h / mass * (force - held), 0.0)
        for bound in (v1, v2):
            if gap > 0.0 and v < bound <= after:
                s[8] = gap
        s[8] -= h
        s[0] += 0.5 * h * (v + after)
        s[1] = after
        s[10] += (after - s[10]) * (1.0 - math.exp(-h / sensor)) if sensor > 0.0 else after - s[10]
        s[11] += 1.0


class Plant:
    """A drawn vehicle, with what :func:`fmus.checking.drive` needs of one."""

    step_size = STEP

    def __init__(self, truth: dict[str, float], profile: VehicleProfile, seed: int) -> None:
        self.warnings: list[str] = []
        self.path = Path("variant")
        self._values = np.array([truth[name] for name in NAMES])
        self._truth, self._profile = truth, profile
        self._random = np.random.default_rng(seed)

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin a drive."""
        self._state, self._late = np.zeros(12), np.zeros((2, _BUFFER))
        self._state[0], self._state[1], self._state[10] = position, speed, speed
        self.position, self.speed, self.acceleration = position, speed, 0.0

    def step(self, force: float, _grade: float = 0.0) -> None:
        """Advance by one step of the controller."""
        inputs, truth = self._profile.inputs, self._truth
        if inputs.acceleration is not None:
            force -= self._profile.inverse_map.friction * self.speed
        drive, brake = max(force, 0.0), max(-force, 0.0)
        if inputs.throttle is not None and inputs.brake is not None:
            full, full_brake = inputs.throttle.full_force, inputs.brake.full_force
            drive = full * min(drive / full, 1.0) ** truth["exponent"]
            brake = min(brake, full_brake)
        before = self.speed
        _advance(self._values, self._state, self._late, drive, brake, round(STEP / FINE))
        shown = float(self._state[10]) + truth["noise"] * self._random.standard_normal()
        if truth["exact_position"]:
            self.position = float(self._state[0])
        else:
            self.position += 0.5 * STEP * (before + shown)
        self.speed, self.acceleration = shown, (shown - before) / STEP

    def close(self) -> None:
        """End the vehicle; there is nothing to close."""


def drawn(seed: int) -> tuple[dict[str, float], VehicleProfile, list[str]]:
    """Draw a vehicle: its truth, its profile and the names of its traits."""
    rng = np.random.default_rng([50, seed])

    def some(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    mass = float(np.exp(some(np.log(700.0), np.log(18_000.0))))
    truth = dict.fromkeys(NAMES, 0.0) | {
        "mass": mass, "constant": mass * some(0.0, 0.15), "viscous": mass * some(0.0, 0.08),
        "quadratic": mass * some(0.0, 5e-4), "drive_lag": some(0.05, 0.9),
        "brake_lag": some(0.05, 0.4), "exponent": 1.0, "exact_position": 1.0,
        **dict.fromkeys(LIMITS, np.inf),
    }  # fmt: skip
    kind = str(rng.choice(["force", "two forces", "pedals", "acceleration"]))
    if rng.random() < 0.4:
        truth["drive_delay"] = round(some(0.03, 0.4), 3)
        truth["brake_delay"] = truth["drive_delay"] if kind == "force" else round(some(0.0, 0.3), 3)
    limits = {
        "limit": {"drive_limit": mass * some(1.5, 5.0)},
        "brake limit": {"brake_limit": mass * some(4.0, 7.0)},
        "power": {"drive_limit": mass * some(2.0, 4.0)},
        "rate": {"drive_rate": mass * some(3.0, 12.0), "drive_lag": 0.0, "drive_delay": 0.0},
    }
    others = {
        "two lags": {"drive_lag2": some(0.1, 0.3)},
        "gears": {"gap": some(0.3, 0.5), "gap_speed": some(3.0, 6.0),
                  "gap_speed2": some(8.0, 12.0)},
        "shake": {"frequency": some(1.5, 3.0), "damping": some(0.12, 0.3),
                  "drive_lag": 0.0, "brake_lag": 0.0, "drive_delay": 0.0, "brake_delay": 0.0},
        "release": {"drive_release": truth["drive_lag"] * some(0.3, 0.6)},
        "sensor": {"sensor": some(0.15, 0.5), "exact_position": float(rng.random() < 0.5)},
        "noise": {"noise": some(0.002, 0.01)},
        "plain": {},
    }  # fmt: skip
    traits = [str(rng.choice(list(others)))]
    if rng.random() < 0.5:
        traits.append(str(rng.choice(list(limits))))
    for trait in traits:
        truth |= (others | limits)[trait]
    if "power" in traits:
        truth["power"] = truth["drive_limit"] * some(5.0, 14.0)
    variable = {name: {"variable": name} for name in ("force", "drive", "brake", "v", "x")}
    full = {"throttle": mass * some(2.5, 5.0), "brake": mass * some(5.0, 8.0)}
    inputs: dict[str, Any] = {
        "force": {"force": variable["force"]},
        "two forces": {"drive_force": variable["drive"], "brake_force": variable["brake"]},
        "pedals": {side: {"variable": side, "full_force": force} for side, force in full.items()},
        "acceleration": {"acceleration": variable["force"]},
    }[kind]
    if kind == "pedals":
        truth["drive_limit"] = min(truth["drive_limit"], full["throttle"])
        truth["brake_limit"] = min(truth["brake_limit"], full["brake"])
        if rng.random() < 0.25:
            truth["exponent"] = some(1.2, 1.8)
            traits.append("progressive")
    values: dict[str, Any] = {"inputs": inputs, "outputs": {"speed": variable["v"]}}
    if kind == "acceleration":
        values["inverse_map"] = {"mass": mass, "friction": mass * some(0.0, 0.1)}
    return truth, make_profile(values, "variant"), [kind, *traits]


def told(truth: dict[str, float]) -> dict[str, dict[str, float]]:
    """Return what the tables of both sides should say."""
    mass, shaken = truth["mass"], truth["frequency"]
    more = 0.0 if truth["exact_position"] else truth["sensor"]
    more += 2.0 * truth["damping"] / (2.0 * np.pi * shaken) if shaken else 0.0
    sides = {}
    for side in SIDES:
        late = truth[f"{side}_lag"] + truth[f"{side}_delay"] + more
        sides[side] = {
            "mass": mass,
            "late": late + (truth["drive_lag2"] if side == "drive" else 0.0),
            "limit": truth[f"{side}_limit"] / mass,
            "rate": truth[f"{side}_rate"] / mass,
        }
    sides["drive"]["power"] = truth["power"] / truth["drive_limit"]
    return sides


def judged(found: Identification, truth: dict[str, dict[str, float]]) -> dict[str, Any]:
    """Return the row of an identification beside the truth."""
    row: dict[str, Any] = {"outcome": "declined" if found.poor else "found"}
    wrong = [found.poor] if found.poor else []
    for index, side in enumerate(SIDES):
        model, true = getattr(found.model, side), truth[side]
        if model is None:
            wrong.append(f"no {side}")
            continue
        error = model.mass / true["mass"] - 1.0
        late = model.lag + model.delay - true["late"]
        half = found.side_intervals[index]
        row |= {f"{side}_mass_error": error, f"{side}_late_error": late,
                f"{side}_covered": int(abs(model.mass - true["mass"]) <= half)}  # fmt: skip
        wrong += [f"{side} M {error:+.1%}"] if abs(error) > MASS else []
        wrong += [f"{side} late {late:+.2f} s"] if abs(late) > LATE else []
        limits = {"limit": model.limit, "rate": model.rate, "power": model.power_from}
        for what, value in limits.items():
            right = true.get(what, np.inf)
            if value is not None and not abs(value / right - 1.0) <= LIMIT:
                wrong.append(f"{side} {what} {value:.3g} for {right:.3g}")
    return row | {"wrong": "; ".join(wrong)}


def variant(seed: int) -> dict[str, Any]:
    """Identify a drawn vehicle and return its row."""
    truth, profile, traits = drawn(seed)
    opened = iter(range(1, 10_000))
    found = _timed(lambda: identify(
        lambda _step: Plant(truth, profile, seed * 1000 + next(opened)),  # type: ignore[arg-type, return-value]
        Mpc(STEP, 15), path=Path("variant"), profile=profile), told(truth))  # fmt: skip
    return {"name": f"variant {seed}", "traits": ", ".join(traits), **found}


def known(path: Path, truth: dict[str, Any]) -> dict[str, Any]:
    """Identify an FMU of known truth and return its row."""
    name = truth.get("profile")
    given = read_profile(path.parent / "profiles" / name) if name else None
    profile = choose_profile(path, given)
    opener = opener_of(path, step_size=STEP, profile=without_guards(profile))
    sides = {side: {what: float(truth.get(f"{side}_{what}", np.inf)) for what in TOLD}
             for side in SIDES}  # fmt: skip
    found = _timed(lambda: identify(opener, Mpc(STEP, 15), path=path, profile=profile), sides)
    return {"name": path.name, "traits": "", **found}


def _timed(identified: Any, truth: dict[str, dict[str, float]]) -> dict[str, Any]:
    begin = time.process_time()
    try:
        row = judged(identified(), truth)
    except FmuError as error:
        row = {"outcome": "refused", "wrong": str(error)}
    return row | {"seconds": round(time.process_time() - begin, 2)}


def main() -> None:
    """Do what is left to do, and print the sums."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--variants", type=int, default=200)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--truth", type=Path)
    args = parser.parse_args()
    rows: dict[str, dict[str, Any]] = {}
    if args.out.exists():
        with args.out.open(newline="", encoding="utf-8") as file:
            rows = {row["name"]: row for row in csv.DictReader(file)}
    work: list[tuple[str, Any]] = [
        (f"variant {seed}", lambda seed=seed: variant(seed))
        for seed in range(args.first, args.first + args.variants)
    ]
    if args.folder and args.truth:
        truths = tomllib.loads(args.truth.read_text(encoding="utf-8"))
        work += [
            (path.name, lambda path=path: known(path, truths[path.stem]))
            for path in (args.folder / f"{name}.fmu" for name in truths)
        ]
    for name, do in work:
        if name not in rows:
            rows[name] = do()
            with args.out.open("a", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, FIELDS)
                if file.tell() == 0:
                    writer.writeheader()
                writer.writerow(rows[name])
            if rows[name]["wrong"]:
                print(f"{name} ({rows[name]['traits']}): {rows[name]['wrong']}")
    for label, chosen in (
        ("variants", [row for row in rows.values() if row["name"].startswith("variant")]),
        ("FMUs", [row for row in rows.values() if row["name"].endswith(".fmu")]),
    ):
        summarise(label, chosen)


def summarise(label: str, rows: list[dict[str, Any]]) -> None:
    """Print the sums of rows."""
    if not rows:
        return
    covered = [int(row[f"{side}_covered"]) for row in rows for side in SIDES
               if row.get(f"{side}_covered") not in (None, "")]  # fmt: skip
    both = [all(str(row.get(f"{side}_covered")) == "1" for side in SIDES) for row in rows]
    right = sum(not row["wrong"] for row in rows)
    declined = sum(row["outcome"] != "found" for row in rows)
    seconds = np.median([float(row["seconds"]) for row in rows])
    print(
        f"{label}: {right} of {len(rows)} right (M within {MASS:.0%}, lag + dead time within "
        f"{LATE} s, limits within {LIMIT:.0%} or none seen); {declined} declined; 95 % intervals "
        f"cover M in {np.mean(covered):.1%} of sides, both in {sum(both)}; {seconds:.1f} s of CPU"
    )


if __name__ == "__main__":
    main()
