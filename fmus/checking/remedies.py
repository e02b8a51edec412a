"""Remedies for a vehicle that fails its check: edits of the profile, tried before they are told.

Each edit is applied in memory, and the FMU is driven with it. An edit is a remedy if position,
speed, start speed, driving, braking and masses are then right. Edits are tried in groups, the most
likely one first; of a group the one that comes closest to what is told counts.
"""

import copy
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain, combinations, islice, product
from math import inf, log
from pathlib import Path
from typing import Any, Final

from fmus.checking import observations as observe
from fmus.checking.answers import Answers, measure
from fmus.checking.expected import Expected
from fmus.checking.findings import Finding
from fmus.checking.judgement import judge
from fmus.checking.manoeuvres import Phase, drive, opener_of, without_guards
from fmus.checking.scale import NAMED
from fmus.description.model import Model
from fmus.description.reading import read_model
from fmus.errors import FmuError
from fmus.isolation import processes_reused
from fmus.profile.vehicle_profile import VehicleProfile, make_profile

MOST: Final = 100  # largest number of edits that are tried
CLOSE: Final = 1.25  # largest factor between a measured mass and the one that is told
FILTERED: Final = 4.0  # [m] difference of position and speed that a filter of half a second makes
EQUAL: Final = 0.02  # logarithm of factors that differ by no more than errors of measurement
UNITS: Final = {
    "speed": ("m/s", "km/h", "mph", "kn", "ft/s"),
    "position": ("m", "km", "cm", "mm", "ft", "mi"),
    "acceleration": ("m/s2", "g", "cm/s2"),
    "force": ("N", "kN", "lbf", "kgf"),
    "throttle": ("1", "%"),
}
SWITCHES: Final = (  # parts of the names of gears, ignitions and the like
    "gear", "ignit", "engage", "enable", "clutch", "park", "brake", "key", "mode", "start", "power",
    "select", "direction",
)  # fmt: skip

Values = dict[str, Any]
Edit = tuple[str, Values]  # the lines to write, and the profile's values with them


@dataclass(frozen=True)
class Remedy:
    """An edit that mends a profile: the lines to write, and the profile with them."""

    lines: str
    profile: VehicleProfile


@processes_reused()
def tried(path: Path, expected: Expected, *, step_size: float) -> Remedy | None:
    """Return the edit of a profile with which its FMU passes, or None if no edit was found.

    Args:
        path: Path of the FMU.
        expected: Assumptions about the vehicle, with the profile that fails.
        step_size: Step size of the controller [s].
    """
    if expected.profile is None:
        return None
    trial = _Trial(path, expected, step_size)
    values = expected.profile.model_dump(exclude_unset=True)
    answers, budget = trial.answers(expected.profile), MOST
    if answers is None:
        return None
    for group in _groups(values, read_model(path), answers, expected):
        best: tuple[float, Remedy] | None = None
        for lines, edited in islice(group, budget):
            budget -= 1
            try:
                profile = make_profile(edited, "edit")
            except FmuError:
                continue
            off = trial.deviation(profile)
            if off < (inf if best is None else best[0] - EQUAL):
                best = off, Remedy(lines, profile)
        if best is not None:
            return best[1]
    return None


class _Trial:
    """Drives of one FMU with edited profiles."""

    def __init__(self, path: Path, expected: Expected, step_size: float) -> None:
        self._path, self._expected, self._step = path, expected, step_size

    def answers(self, profile: VehicleProfile) -> Answers | None:
        """Return the measured answers with a profile, or None if the FMU fails."""
        free = without_guards(profile)
        opener = opener_of(self._path, step_size=self._step, profile=free)
        try:
            return measure(opener, brake_force=self._expected.brake_force)
        except FmuError:
            return None

    def deviation(self, profile: VehicleProfile) -> float:
        """Return by how much the masses deviate, as a logarithm; infinite if a test fails."""
        expected = replace(self._expected, profile=profile)
        opener = opener_of(self._path, step_size=self._step, profile=profile)
        force, start = expected.force, expected.start_speed
        try:
            response = drive(opener, [Phase(force, 2.0), Phase(0.0, 1.0), Phase(-force, 2.0)])
            if self._wrong(
                observe.position_follows_speed(response, expected),
                observe.acceleration_follows_speed(response, expected),
            ):
                return inf
            rolling = drive(opener, [Phase(0.0, 0.1)], speed=start)
            if self._wrong(observe.start_speed(rolling, expected)):
                return inf
            answers = measure(opener, brake_force=expected.brake_force)
        except FmuError:
            return inf
        if self._wrong(*judge(answers, expected.told, profile)):
            return inf
        drive_mass, brake_mass, told = answers.drive_mass, answers.brake_mass, expected.told
        if not (0.0 < drive_mass < inf and 0.0 < brake_mass < inf):
            return inf
        off = abs(log(brake_mass / drive_mass))
        for mass, known in ((drive_mass, told.drive), (brake_mass, told.brake)):
            off = max(off, 0.0 if known is None else abs(log(known.excess(mass))))
        return off if off <= log(CLOSE) else inf

    def _wrong(self, *findings: Finding) -> bool:
        return any(finding.verdict in ("fail", "ask") for finding in findings)


def _groups(
    values: Values, model: Model, answers: Answers, expected: Expected
) -> Iterator[Iterator[Edit]]:
    """Yield the groups of edits, the most likely one first."""
    axes = [role for role in values["inputs"] if isinstance(values["inputs"][role], dict)]
    driving = [role for role in axes if role != "grade"]
    yield chain(_leads(values, answers, expected), _jumps(values))
    yield _plain(values, driving)
    yield _units(values, "outputs", ["position"])
    yield _signs(values, driving)
    yield _swaps(values, driving)
    if answers is None or not answers.braking > 0.0:
        yield _switches(values, model)
    places = [("outputs", ["speed"]), ("inputs", driving), ("initial", ["speed"])]
    places += [("inputs", [role]) for role in driving if len(driving) > 1]
    yield chain.from_iterable(_units(values, *place) for place in places)
    yield _gains(values, driving, answers, expected)
    yield _switches(values, model)
    yield _named(values, driving)
    yield _others(values, model)


def _edited(values: Values, *edits: tuple[str, str, str, object]) -> Edit:
    """Return the values with keys of tables changed: table, role, key, value."""
    changed, lines = copy.deepcopy(values), []
    for table, role, key, value in edits:
        changed.setdefault(table, {}).setdefault(role, {})[key] = value
        shown = f'"{value}"' if isinstance(value, str) else f"{value}"
        lines.append(f"`{key} = {shown}` in [{table}.{role}]")
    return " and ".join(lines), changed


def _units(values: Values, table: str, roles: list[str]) -> Iterator[Edit]:
    present = [role for role in roles if role in values.get(table, {})]
    if not present:
        return
    kind = {"brake": "throttle", "drive_force": "force", "brake_force": "force"}
    first = kind.get(present[0], present[0]).replace("speed_setpoint", "speed")
    both = table == "outputs" and "speed" in present and "speed" in values.get("initial", {})
    for unit in UNITS[first]:
        edits = [(table, role, "unit", unit) for role in present]
        yield _edited(values, *edits)
        if both:
            yield _edited(values, *edits, ("initial", "speed", "unit", unit))


def _plain(values: Values, driving: list[str]) -> Iterator[Edit]:
    """Yield gains of 1 in place of others, one by one and all of the inputs'."""
    axes = [("inputs", role) for role in driving]
    axes += [(table, role) for table in ("outputs", "initial") for role in values.get(table, {})]
    odd = [
        (table, role, "gain", 1.0)
        for table, role in axes
        if isinstance(values[table][role], dict) and values[table][role].get("gain", 1.0) != 1.0
    ]
    for edit in odd:
        yield _edited(values, edit)
    inputs = [edit for edit in odd if edit[0] == "inputs"]
    speeds = [edit for edit in odd if edit[1] == "speed"]
    for several in (inputs, speeds):
        if len(several) > 1:
            yield _edited(values, *several)


def _leads(values: Values, answers: Answers, expected: Expected) -> Iterator[Edit]:
    """Yield the lead of a speed controller whose profile has none.

    With a lead T of one step, v' = (v_set - v) / tau = T / tau (u - alpha v) / M. Therefore the
    vehicle seems tau / T times as heavy as M of the inverse map.
    """
    setpoint, told = values["inputs"].get("speed_setpoint"), expected.told.drive
    if setpoint and setpoint.get("lead") is None and told and answers.drive_mass < inf:
        lead = answers.traces[0].step_size * told.excess(answers.drive_mass)
        yield _edited(values, ("inputs", "speed_setpoint", "lead", float(f"{lead:.2g}")))


def _jumps(values: Values) -> Iterator[Edit]:
    """Yield a larger tolerance between position and speed, which a filtered speed needs."""
    if "position" in values["outputs"]:
        changed = copy.deepcopy(values)
        changed.setdefault("limits", {})["position_jump"] = FILTERED
        yield f"`position_jump = {FILTERED:g}` in [limits]", changed


def _signs(values: Values, driving: list[str]) -> Iterator[Edit]:
    places = [("inputs", role) for role in driving]
    places += [("outputs", role) for role in ("speed", "position", "acceleration")]
    for table, role in places:
        if role in values[table]:
            gain = -(values[table][role].get("gain") or 1.0)
            yield _edited(values, (table, role, "gain", gain))
    if len(driving) > 1:
        yield _edited(
            values,
            *(("inputs", r, "gain", -(values["inputs"][r].get("gain") or 1.0)) for r in driving),
        )


def _swaps(values: Values, driving: list[str]) -> Iterator[Edit]:
    if len(driving) == 2:
        one, two = (values["inputs"][role]["variable"] for role in driving)
        yield _edited(
            values,
            ("inputs", driving[0], "variable", two),
            ("inputs", driving[1], "variable", one),
        )


def _switches(values: Values, model: Model) -> Iterator[Edit]:
    """Yield other values of parameters and unused inputs that look like a gear or an ignition."""
    used = {axis["variable"] for axis in values["inputs"].values() if isinstance(axis, dict)}
    options: list[list[tuple[str, object]]] = []
    for variable in model.variables.values():
        name = variable.name
        if name in used or variable.causality not in ("input", "parameter"):
            continue
        if any(word in name.lower() for word in SWITCHES):
            now = values.get("parameters", {}).get(name, variable.start)
            options.append([(name, setting) for setting in _settings(str(variable.kind), now)])
    yield from (
        _set(values, choice) for several in options for choice in ([one] for one in several)
    )
    for number in (2, 3):
        for several in combinations(options, number):
            yield from (_set(values, list(choice)) for choice in product(*several))


def _settings(kind: str, now: object) -> tuple[object, ...]:
    """Return the values to try of a variable of some type that has the value ``now``."""
    if kind == "Boolean":
        return (str(now).lower() not in ("true", "1"),)
    whole = "Int" in kind or "Enum" in kind
    return tuple(n for n in ((1, 2, 3, 4) if whole else (1.0, 0.0)) if str(n) != str(now))


def _set(values: Values, settings: list[tuple[str, object]]) -> Edit:
    changed = copy.deepcopy(values)
    changed.setdefault("parameters", {}).update(settings)
    lines = (f"`{name} = {str(v).lower()}`" for name, v in settings)
    return f"{' and '.join(lines)} in [parameters]", changed


def _gains(
    values: Values, driving: list[str], answers: Answers, expected: Expected
) -> Iterator[Edit]:
    """Yield gains by the measured factor: of inputs, of the speed, of a torque by its radius."""
    told = expected.told
    if told.drive is None or told.brake is None:
        return
    factors = [
        told.drive.excess(answers.drive_mass),
        told.brake.excess(answers.brake_mass),
    ]
    if any(not 0.0 < factor < inf for factor in factors):
        return
    edits = []
    for role, factor in zip(driving, factors, strict=False):
        gain = (values["inputs"][role].get("gain") or 1.0) / factor
        edits.append(("inputs", role, "gain", float(f"{gain:.4g}")))
        yield _edited(values, edits[-1])
    if len(edits) > 1:
        yield _edited(values, *edits)
    gain = (values["outputs"]["speed"].get("gain") or 1.0) * factors[0]
    edit = ("outputs", "speed", "gain", float(f"{gain:.4g}"))
    yield _edited(values, edit)
    if "speed" in values.get("initial", {}):
        yield _edited(values, edit, ("initial", "speed", "gain", float(f"{gain:.4g}")))
    if "acceleration" in driving:
        yield from _as_force(values, factors[0], expected)


def _named(values: Values, driving: list[str]) -> Iterator[Edit]:
    """Yield gains of the inputs by named factors, where no factor can be measured."""
    for factor in chain.from_iterable((value, 1.0 / value) for value, _ in NAMED):
        gains = {role: (values["inputs"][role].get("gain") or 1.0) * factor for role in driving}
        edits = [("inputs", role, "gain", float(f"{gain:.4g}")) for role, gain in gains.items()]
        yield _edited(values, *edits)


def _as_force(values: Values, factor: float, expected: Expected) -> Iterator[Edit]:
    """Yield the profile whose acceleration input is a force, or a torque over the wheel radius."""
    axis = values["inputs"]["acceleration"]
    mass = expected.profile.inverse_map.mass if expected.profile else expected.mass
    changed = copy.deepcopy(values)
    del changed["inputs"]["acceleration"]
    gain = float(f"{mass * (axis.get('gain') or 1.0) / factor:.4g}")
    changed["inputs"]["force"] = {"variable": axis["variable"], "gain": gain}
    name = f'`variable = "{axis["variable"]}"`'
    yield f"[inputs.force] with {name} and `gain = {gain}`, no [inputs.acceleration]", changed


def _others(values: Values, model: Model) -> Iterator[Edit]:
    """Yield other variables for the position and the acceleration, and profiles without them."""
    outputs = [v.name for v in model.variables.values() if v.causality == "output"]
    for role in ("position", "acceleration"):
        if role in values["outputs"]:
            taken = (values["outputs"][role]["variable"], values["outputs"]["speed"]["variable"])
            for name in outputs[:10]:
                if name not in taken:
                    yield _edited(values, ("outputs", role, "variable", name))
    optional = (("outputs", "position"), ("outputs", "acceleration"), ("initial", "speed"))
    for table, role in optional:
        if role in values.get(table, {}):
            changed = copy.deepcopy(values)
            del changed[table][role]
            yield f"the profile without [{table}.{role}]", changed
