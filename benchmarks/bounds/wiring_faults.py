"""Builds 20 wiring faults on each of five plants, and counts the runs that are not refused.

Run: python benchmarks/bounds/wiring_faults.py [--out wiring_faults.json] [--folder DIR] [--check]

A fault is a line of the profile that is wrong: a unit's factor, a sign, an input that does nothing,
a gear that is not engaged. Each profile tells the plant's mass in [model]. A factor of 3 and more
and all other faults must end a run; a factor of 1.5 to 3 must be a question. The plants themselves,
and with --folder the FMUs of a folder with the profiles DIR/profiles/right_NAME.toml, must run.
With --check, the FMU itself has the fault (its description is wrong, the profile is not), and the
lines that `giveway fmu check` has tried and prints are counted. A second call goes on where the
first has ended.
"""

from __future__ import annotations

import argparse
import copy
import json
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

import tomlkit

import giveway

TESTS: Final = Path(__file__).resolve().parents[2] / "tests"
PLANTS: Final[dict[str, dict[str, Any]]] = {  # options of the tests' cars
    "force": {"role": "force", "values": {"mass": 1200.0, "lag": 0.1}},
    "two forces": {"role": "drive_brake", "values": {"mass": 1450.0, "lag": 0.2, "drag": 0.4}},
    "acceleration": {"role": "acceleration", "values": {"mass": 1300.0, "lag": 0.3}},
    "pedals": {"role": "throttle_brake", "values": {"mass": 1600.0, "lag": 0.1}},
    "van": {"role": "drive_brake", "values": {"mass": 2500.0, "friction": 200.0, "lag": 0.3}},
}
HUGE: Final = 1e9  # gain with which an input does nothing
# name: which axes, the factor of their gain (a factor above 1 makes an input too weak), verdict
FAULTS: Final[dict[str, tuple[str, float, str]]] = {
    "drive reversed": ("drive", -1.0, "refused"),
    "brake reversed": ("brake", -1.0, "refused"),
    "brake absent": ("brake", HUGE, "refused"),
    "drive absent": ("drive", HUGE, "refused"),
    "brake 100 times too weak": ("brake", 100.0, "refused"),
    "1000 times too weak": ("inputs", 1e3, "refused"),
    "1000 times too strong": ("inputs", 1e-3, "refused"),
    "100 times too weak": ("inputs", 100.0, "refused"),
    "100 times too strong": ("inputs", 0.01, "refused"),
    "kgf": ("inputs", 9.80665, "refused"),
    "kgf, inverse": ("inputs", 1 / 9.80665, "refused"),
    "lbf": ("inputs", 4.448222, "refused"),
    "lbf, inverse": ("inputs", 1 / 4.448222, "refused"),
    "km/h": ("speed", 3.6, "refused"),
    "km/h, inverse": ("speed", 1 / 3.6, "refused"),
    "not engaged": ("engaged", 0.0, "refused"),
    "mph": ("speed", 2.236936, "question"),
    "knots": ("speed", 1.943844, "question"),
    "two": ("inputs", 2.0, "question"),
    "half": ("inputs", 0.5, "question"),
}
AXES: Final = {  # axes by name; with one input, a fault of the brake is one of both
    "drive": ("force", "drive_force", "acceleration", "throttle"),
    "brake": ("force", "brake_force", "acceleration", "brake"),
}
AXES["inputs"] = tuple(dict.fromkeys((*AXES["drive"], *AXES["brake"])))


def right(profile: dict[str, Any], values: dict[str, float]) -> dict[str, Any]:
    """Return a plant's profile with its mass in [model]."""
    model = {
        "mass": values["mass"], "friction": values.get("friction", 100.0), "r_squared": 1.0,
        "speed_error": 0.01, "position_error": 0.1, "horizon": 0.75, "time_step": 0.05,
        "lag": values.get("lag", 0.0),
    }  # fmt: skip
    return profile | {"model": model}


def with_fault(profile: dict[str, Any], name: str) -> dict[str, Any]:
    """Return a profile with one fault."""
    what, factor, _ = FAULTS[name]
    wrong = copy.deepcopy(profile)
    if what == "engaged":
        wrong["parameters"] = {"engaged": bool(factor)}
    elif what == "speed":
        for table in (wrong["outputs"], wrong["initial"]):
            if "speed" in table:
                table["speed"]["gain"] = factor
    else:
        for role in set(AXES[what]) & set(wrong["inputs"]):
            wrong["inputs"][role]["gain"] = factor
    return wrong


def spoken(role: str, name: str) -> dict[str, Any]:
    """Return the options of a car that has a fault itself, while its description stays right."""
    what, factor, _ = FAULTS[name]
    if what == "engaged":
        return {"engaged": 0.0}
    if what == "speed":
        return {"spoken": dict.fromkeys(("speed", "initial_speed"), (1.0 / factor, 0.0))}
    names = {"acceleration": "wanted_acceleration"}
    axes = {"drive_brake": ("drive_force", "brake_force"), "throttle_brake": ("throttle", "brake")}
    faulty = [axis for axis in axes.get(role, (role,)) if axis in AXES[what]]
    return {"spoken": {names.get(axis, axis): (1.0 / factor, 0.0) for axis in faulty}}


def verdict_of(fmu: Path, profile: Path) -> tuple[str, str]:
    """Return how a short run with a profile ends, and the message."""
    from fmus import read_profile

    model = read_profile(profile).model
    limit = {} if model is None else {"force_limit": 8.0 * model.mass}
    vehicle = {"fmu": str(fmu), "profile": str(profile), **limit}
    try:
        giveway.run({"scenario": "encounter", "time_limit": 2.0, "vehicle": vehicle})
    except giveway.GivewayError as error:
        said = str(error)
        return "question" if "does it weigh that?" in said else "refused", said
    return "runs", ""


def remedy_of(fmu: Path, profile: Path) -> str:
    """Return the lines that `giveway fmu check` has tried and prints, joined; empty without any."""
    from fmus import read_profile
    from fmus.checking import expected_of
    from fmus.checking.remedies import tried

    given = read_profile(profile)
    expected = expected_of(given, force_limit=8.0 * given.model.mass if given.model else 8000.0)
    found = tried(fmu, expected, step_size=0.05)
    return "" if found is None else found.lines


def cases(
    folder: Path, others: Path | None, inside: bool
) -> list[tuple[str, Path, dict[str, Any], str]]:
    """Return name, FMU, profile and expected verdict of each drive.

    Args:
        folder: Folder for the FMUs.
        others: Folder of further FMUs, or None.
        inside: True if the FMUs have the faults, and not the profiles.
    """
    sys.path.insert(0, str(TESTS))
    from support.fmus.zoo import Zoo

    zoo, found = Zoo(folder, folder / "cache"), []
    for plant, options in PLANTS.items():
        options = options | {"outputs": ("speed",), "initial": ("speed",)}
        fmu = zoo.car(**options)
        profile = right(zoo.profile(fmu), options["values"])
        found.append((f"{plant}: right", fmu, profile, "runs"))
        for name, (_, _, expected) in FAULTS.items():
            wrong = with_fault(profile, name)
            if inside:
                more = spoken(options["role"], name)
                values = options["values"] | {k: v for k, v in more.items() if k == "engaged"}
                more = {key: value for key, value in more.items() if key != "engaged"}
                fmu, wrong = zoo.car(**options | more | {"values": values}), profile
            found.append((f"{plant}: {name}", fmu, wrong, expected))
    for path in sorted((others / "profiles").glob("right_*.toml")) if others else []:
        fmu = path.parents[1] / f"{path.stem.removeprefix('right_')}.fmu"
        found.append((f"{fmu.stem}: right", fmu, tomlkit.parse(path.read_text()).unwrap(), "runs"))
    return found


def main() -> int:
    """Do the drives that are not done yet, and print those that end otherwise than expected."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("wiring_faults.json"))
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--check", action="store_true")
    chosen = parser.parse_args()
    done: dict[str, list[str]] = json.loads(chosen.out.read_text()) if chosen.out.exists() else {}
    wrong, mended, faulty = [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for name, fmu, profile, expected in cases(Path(folder), chosen.folder, chosen.check):
            key = f"check of {name}" if chosen.check else name
            if chosen.check and expected == "runs":
                continue
            if key not in done:
                file = Path(folder, "profile.toml")
                file.write_text(tomlkit.dumps(profile), encoding="utf-8")
                if chosen.check:
                    done[key] = [expected, remedy_of(fmu, file)]
                else:
                    done[key] = list(verdict_of(fmu, file))
                chosen.out.write_text(json.dumps(done, indent=1), encoding="utf-8")
            got, said = done[key]
            faulty += expected != "runs"
            mended += chosen.check and bool(said)
            bad = not said if chosen.check else got != expected
            if bad:
                wrong.append(name)
                print(f"{name}: {got}, expected {expected}; {said}", flush=True)
    if chosen.check:
        print(f"{mended} of {faulty} faults get a line that mends them")
        return 0
    print(f"{len(wrong)} of {len(done)} drives end otherwise than expected")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
