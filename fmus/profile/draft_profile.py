"""The drafting of a vehicle profile from an FMU's own description.

What is certain is written as a setting. What is open is written as a question, in lines that begin
with ``# ?``. A draft without questions is a profile that runs.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from fmus.description.model import Kind, Model, Variable
from fmus.errors import FmuProfileError
from fmus.profile.draft import Draft, Entry, Line, toml_value
from fmus.profile.matching import ROLES, Guess, guesses, unambiguous
from fmus.profile.questions import (
    axis_question,
    braking_question,
    channel_name,
    contradiction,
    idle_brake,
    numbers,
    open_line,
    signed_question,
    unit_question,
)
from fmus.profile.vehicle_profile import VehicleProfile, make_profile
from fmus.profile.wheels import radius_line, variables_line, wheel_group
from fmus.text import listed, printable

LONGEST_STEP: Final = 10.0  # Longest step [s] that a profile may have
NAMED: Final = 3  # Largest number of doubts in an error


def draft_profile(model: Model) -> Draft:
    """Return a draft from names, units and causality."""
    inputs = [v for v in model.variables.values() if v.causality == "input"]
    entries, used = _inputs(model, inputs) if numbers(inputs) else _without_inputs(model)
    idle = [v.name for v in inputs if v.name not in used]
    entries = [_fmu(model), *entries, *_outputs(model), *_initial(model)]
    return Draft(model, tuple(entries), tuple(_remarks(model, idle if used else [])))


def require_confident(draft: Draft, path: Path) -> VehicleProfile:
    """Return the profile of a draft in which nothing is open.

    Raises:
        FmuProfileError: something is open; the message says what, and the lines to write.
    """
    doubts = draft.doubts
    if doubts:
        more = f"; and {len(doubts) - NAMED} more" if len(doubts) > NAMED else ""
        raise FmuProfileError(
            f"{path}: needs a vehicle profile: {'; '.join(doubts[:NAMED])}{more}; 'giveway fmu "
            f"inspect {path} --draft car.toml' writes the rest"
        )
    return make_profile(draft.values, f"{path}: drafted profile")


# ---- how it is stepped ----


def _fmu(model: Model) -> Entry:
    kinds = list(model.interfaces)
    kind = Kind.CO_SIMULATION if Kind.CO_SIMULATION in kinds else kinds[0]
    others = ", ".join(other for other in kinds if other != kind)
    lines = [Line("kind", str(kind), f"the FMU offers {others}, too" if others else "")]
    interface, step = model.interfaces[kind], model.default_step
    if interface.fixed_internal_step is not None:
        lines.append(Line("step", interface.fixed_internal_step, "s, its fixed internal step"))
    elif kind is Kind.CO_SIMULATION and not interface.variable_step and step is not None:
        comment = "s, of its default experiment; it takes steps of one length only"
        lines.append(Line("step", step, comment, sure=step <= LONGEST_STEP))
    return Entry("fmu", tuple(lines))


# ---- inputs ----

WAYS: Final = (
    ("force",),
    ("drive_force", "brake_force"),
    ("acceleration",),
    ("throttle", "brake"),
    ("speed_setpoint",),
)


def _inputs(model: Model, inputs: Sequence[Variable]) -> tuple[list[Entry], set[str]]:
    """Return the tables for one way to drive the vehicle, and the variables that they use."""
    ranked = {role: guesses(model, role, inputs) for way in WAYS for role in way}
    ways = sorted(
        (way for way in WAYS if all(ranked[role] for role in way) and _distinct(ranked, way)),
        key=lambda way: -_merit(ranked, way),
    )
    if not ways:
        return [_no_input(model, ranked, inputs)], set()
    way = ways[0]
    rivals = [other for other in ways[1:] if _merit(ranked, other) == _merit(ranked, way)]
    entries = [_axis(model, "inputs", role, ranked[role]) for role in way]
    other = idle_brake(ranked, way)
    if other:
        entries = [_open(entry, entry.doubt or other) for entry in entries]
    if rivals:
        doubt = _choice(ranked, (way, *rivals))
        entries = [_open(entry, doubt) for entry in entries]
        entries += [
            _axis(model, "inputs", role, ranked[role], alternative=True) for role in rivals[0]
        ]
    return entries, {ranked[role][0].channel.variable.name for role in way}


def _choice(ranked: dict[str, list[Guess]], ways: tuple[tuple[str, ...], ...]) -> str:
    """Return the question which of several ways to drive is meant."""
    names = [" and ".join(f"'{ranked[role][0].channel.name}'" for role in way) for way in ways]
    roles = [" and ".join(way) for way in ways]
    if len(set(names)) == 1:
        return f"{printable(names[0], 60)} has no unit: is it {' or '.join(roles)}? Add its unit"
    what = "; ".join(f"{role}: {name}" for role, name in zip(roles, names, strict=True))
    return f"{printable(what)}? Choose one way to drive"


def _distinct(ranked: dict[str, list[Guess]], way: tuple[str, ...]) -> bool:
    names = {ranked[role][0].channel.name for role in way}
    return len(names) == len(way)


def _merit(ranked: dict[str, list[Guess]], way: tuple[str, ...]) -> float:
    """Rate a way to drive by its weakest guess; two inputs are better than a single one."""
    weakest = min(ranked[role][0].score for role in way)
    fits = min(-1 if ranked[role][0].fits is False else 0 for role in way)
    both = 1 if len(way) > 1 and way != ("throttle", "brake") else 0
    return fits * 100.0 + weakest + both


def _without_inputs(model: Model) -> tuple[list[Entry], set[str]]:
    """Return the profile lines for an FMU without inputs, and the names of the used variables.

    Some tools export tunable parameters instead of inputs. The lines then ask whether these
    parameters drive the FMU.
    """
    tunable = [
        v
        for v in model.variables.values()
        if v.causality == "parameter" and v.variability == "tunable"
    ]
    entries, _ = _inputs(model, tunable)
    if not tunable or "?" in {line.value for entry in entries for line in entry.lines}:
        return _inputs(model, [])
    names = " and ".join(f"'{printable(str(entry.lines[0].value), 40)}'" for entry in entries)
    doubt = f"the FMU has no input; is it driven by {names}, tunable? Then take the lines"
    return [_open(entry, doubt) for entry in entries], set()


def _no_input(model: Model, ranked: dict[str, list[Guess]], inputs: Sequence[Variable]) -> Entry:
    signed = signed_question(ranked, inputs)
    if signed is not None:
        lines, doubt = signed
        return Entry("inputs.force", lines, "", doubt, sure=False)
    for one, other in (("throttle", "brake"), ("drive_force", "brake_force")):
        for present, missing in ((one, other), (other, one)):
            if ranked[present] and not ranked[missing]:
                name = ranked[present][0].channel.name
                doubt = f"'{name}' is a {present}, but no input is a {missing}; name it"
                line = Line("variable", "?", "an input of the FMU", sure=False)
                return Entry(f"inputs.{missing}", (line,), "", printable(doubt), sure=False)
    names = numbers(inputs)
    hint = axis_question(model, inputs)
    if hint is not None:
        lines, doubt = hint
        return Entry("inputs.force", lines, "", doubt, False)
    has = f"its inputs are {listed(names)}" if names else "it has no numeric input"
    doubt = f'no input that drives a vehicle; {has}; add [inputs.force] variable = "..."'
    lines = (
        Line("variable", names[0] if len(names) == 1 else "?", listed(names), sure=False),
        Line("unit", "?", "N, kN; or another table: docs/vehicles.md", sure=False),
    )
    return Entry("inputs.force", lines, "", doubt, sure=False)


# ---- outputs ----


def _outputs(model: Model) -> list[Entry]:
    outputs = [v for v in model.variables.values() if v.causality == "output"]
    inner = [
        v
        for v in model.variables.values()
        if v.causality == "local" and v.variability in {"continuous", "discrete"}
    ]
    entries = []
    speed = guesses(model, "speed", outputs)
    if speed and speed[0].fits is not False:
        entries.append(_axis(model, "outputs", "speed", speed))
    elif turning := _of_wheels(model, outputs, "speed", speed):
        entries.append(turning)
    elif hidden := [g for g in guesses(model, "speed", inner) if g.name_score >= 9]:
        entry = _axis(model, "outputs", "speed", hidden)
        name = printable(hidden[0].channel.name, 60)
        doubt = f"no output is a speed; is it the local variable '{name}'? Then write variable = "
        entries.append(_open(entry, f"{doubt}{toml_value(hidden[0].channel.name)}"))
    elif speed:
        entries.append(_axis(model, "outputs", "speed", speed))
    else:
        names = numbers(outputs)
        doubt = f"no output is a speed; its outputs are {listed(names) or 'none'}"
        lines = (Line("variable", "?", listed(names), sure=False),)
        entries.append(Entry("outputs.speed", lines, "", doubt, sure=False))
    position = [g for g in guesses(model, "position", outputs) if g.fits is not False]
    if position:
        entries.append(_axis(model, "outputs", "position", position))
    elif entries[0].sure and (turned := _of_wheels(model, outputs, "position", [])):
        entries.append(turned)
    acceleration = guesses(model, "measured_acceleration", outputs)
    # it is optional, and not worth a question
    if unambiguous(acceleration) and acceleration[0].fits:
        entries.append(_axis(model, "outputs", "acceleration", acceleration))
    return entries


def _of_wheels(
    model: Model, outputs: Sequence[Variable], role: str, contradictory: Sequence[Guess]
) -> Entry | None:
    """Return the table of a motion that is read from the wheels, or None without them."""
    wanted = ROLES[role].dimension
    group = wheel_group(model, outputs, wanted, named=True)
    alone = [guess.channel.variable for guess in contradictory]
    group = group or wheel_group(model, alone, wanted, named=False)
    if not group:
        return None
    radius, question = radius_line(model, group[0].name)
    return Entry(f"outputs.{role}", (variables_line(group), radius), "", question)


# ---- the start ----


def _initial(model: Model) -> list[Entry]:
    """Return the variables for the start; without a clear one, the vehicle is run up to speed."""
    free = [
        v
        for v in model.variables.values()
        if v.settable and v.causality in {"parameter", "input", "structuralParameter"}
    ]
    states = [v for v in model.variables.values() if v.settable and v.causality == "output"]
    entries = []
    for quantity in ("speed", "position"):
        ranked = [g for g in guesses(model, f"initial_{quantity}", free) if g.fits is not False]
        if not ranked:  # the output itself may have a start value
            ranked = [g for g in guesses(model, quantity, states) if g.fits]
        if unambiguous(ranked) and ranked[0].name_score >= 9:
            entries.append(_axis(model, "initial", quantity, ranked))
    return entries


# ---- words ----


def _axis(
    model: Model, table: str, role: str, ranked: list[Guess], *, alternative: bool = False
) -> Entry:
    """Return the table of a role, written for its best guess, which comes first."""
    best = ranked[0]
    variable, name = best.channel.variable, channel_name(best.channel)
    place = f"{table}.{role}"
    wanted = ROLES[_role_key(table, role)].dimension
    lines = [Line("variable", name, variable.description)]
    doubt = ""
    sure = unambiguous(ranked) and not alternative
    if not unambiguous(ranked):
        ties = [g for g in ranked if g.score == best.score]
        names = listed([f"'{printable(g.channel.name, 40)}'" for g in ties])
        doubt = f"which of {names}? write variable = {toml_value(name)} or another"
    elif variable.size > 1:
        every = f'variables = ["{printable(variable.name, 60)}"]'
        doubt = f"'{printable(variable.name, 60)}' is an array of {variable.size}; which element?"
        doubt += f" Or all: {every}"
        sure = False
    if variable.negated:
        minus = f"'{printable(name, 60)}' is minus another variable: is it positive forwards?"
        doubt = doubt or f"{minus} Then keep the line, else add gain = -1.0"
    pedal = role in {"throttle", "brake"}
    if best.fits is None:
        line, question = unit_question(variable, wanted, pedal=pedal)
        lines.append(line)
        doubt = doubt or question
    elif best.fits is False:
        line, question = contradiction(model, best, variable, role)
        lines.append(line)
        doubt = doubt or question
    else:
        lines[0] = Line("variable", name, f"{variable.unit}: {variable.description}".rstrip(": "))
    if table == "inputs":
        more, question = braking_question(role, variable)
        lines += more
        doubt = "; ".join(filter(None, (doubt, question)))
    if alternative:
        return Entry(place, tuple(lines), "or else:", "", sure=False)
    return Entry(place, tuple(lines), "", doubt, sure)


def _role_key(table: str, role: str) -> str:
    if table == "initial":
        return f"initial_{role}"
    return "measured_acceleration" if (table, role) == ("outputs", "acceleration") else role


def _open(entry: Entry, doubt: str) -> Entry:
    return Entry(entry.table, tuple(map(open_line, entry.lines)), entry.why, doubt, sure=False)


def _remarks(model: Model, idle: Sequence[str]) -> Iterable[str]:
    if idle:
        names = listed([f"'{printable(name, 40)}'" for name in idle])
        yield f"Inputs that keep their start values: {names}; [parameters] sets others."
    if any(interface.needs_execution_tool for interface in model.interfaces.values()):
        yield "The FMU needs the tool that made it, installed on this machine."
