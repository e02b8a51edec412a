"""The command ``giveway fmu inspect``: the description of an FMU, and the draft of its profile.

Nothing of the FMU is unpacked, loaded or run.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from rich.console import Console
from rich.table import Column, Table
from rich.text import Text

from fmus import FmuError
from fmus.archive.archive_check import open_archive
from fmus.description.binaries import binary_of, this_platform
from fmus.description.model import Interface, Model, Unit, Variable
from fmus.description.reading import model_of
from fmus.description.units import quantity, to_si
from fmus.errors import FmuPlatformError
from fmus.fmi.validation import findings
from fmus.profile.controllers.controller_draft import ControllerDraft, draft_controller
from fmus.profile.draft import Draft
from fmus.profile.draft_profile import draft_profile
from fmus.text import printable
from giveway.cli.exit import fail
from giveway.cli.screen.printing import print_json
from giveway.config.files.schema_names import PROFILE, with_schema

SHOWN: Final = 12  # Number of rows shown of a list
SHOWN_FINDINGS: Final = 4
VALIDATED: Final = 5000  # Largest number of variables for FMPy's validation, which is slow
REFUSED: Final = 2
GROUPS: Final = (
    ("Inputs", frozenset({"input"})),
    ("Outputs", frozenset({"output"})),
    ("Parameters", frozenset({"parameter", "structuralParameter"})),
)
INNER: Final = (("Local variables", frozenset({"local", "calculatedParameter"})),)


def inspect_command(
    path: Path,
    draft: Path | None = None,
    *,
    everything: bool = False,
    controller: bool = False,
    as_json: bool = False,
) -> int:
    """Print the description of an FMU and a drafted profile.

    Args:
        path: File of the FMU.
        draft: File for the drafted profile, which must not exist, or None.
        everything: True for whole lists instead of their beginnings.
        controller: True if the FMU is a controller and no vehicle.
        as_json: True to print all of this as JSON.

    Returns:
        0, or 2 for an FMU that is refused or a file that exists already.
    """
    try:
        archive = open_archive(path)
        model = model_of(archive)
    except FmuError as error:
        return fail(str(error), REFUSED)
    drafted: Draft | ControllerDraft
    drafted = draft_controller(model) if controller else draft_profile(model)
    text = drafted.toml if controller else with_schema(drafted.toml, PROFILE)
    console = Console(quiet=as_json)
    for part in _parts(model, archive.sha256, everything=everything):
        console.print(part)
        console.print()
    console.print(_profile(text), soft_wrap=True)
    if draft is not None:
        try:
            with draft.open("x", encoding="utf-8") as file:
                file.write(text)
        except FileExistsError:
            return fail(f"{draft}: exists already; remove it, or name another file", REFUSED)
        except OSError as error:
            return fail(f"{draft}: cannot be written: {error.strerror}", REFUSED)
    console.print(_verdict(drafted, draft), soft_wrap=True)
    if as_json:
        told = {"sha256": archive.sha256, "profile": text, "questions": _questions(drafted)}
        print_json(_described(model) | told)
    return 0


def _described(model: Model) -> dict[str, Any]:
    """Return the description of an FMU for a script."""
    return {
        "fmu": str(model.path),
        "model": model.name,
        "description": model.description,
        "generation_tool": model.generation_tool,
        "fmi_version": model.fmi_version,
        "interfaces": {kind.value: dict(one.flags) for kind, one in model.interfaces.items()},
        "platforms": list(model.platforms),
        "default_step": model.default_step,
        "variables": [asdict(variable) for variable in model.variables.values()],
        "remarks": _remarks(model),
    }


def _parts(model: Model, sha256: str, *, everything: bool) -> Iterator[Table]:
    yield _overview(model, sha256)
    shown = []
    for title, causalities in (*GROUPS, *(INNER if everything else ())):
        variables = [v for v in model.variables.values() if v.causality in causalities]
        shown += variables
        if variables:
            yield _variables(title, variables, len(variables) if everything else SHOWN)
    units = dict.fromkeys(v.unit for v in shown if v.unit)
    if units:
        yield _units(model, list(units), len(units) if everything else SHOWN)
    found = _remarks(model)
    if found:
        yield _findings(found, len(found) if everything else SHOWN_FINDINGS)


def _remarks(model: Model) -> list[str]:
    """Return what is not as the standard wants it; validation is left out where it is slow."""
    validated = len(model.variables) <= VALIDATED and model.system is None
    return findings(model.path) if validated else []


# ---- the description ----


def _overview(model: Model, sha256: str) -> Table:
    columns = Column(style="dim", no_wrap=True), Column(overflow="fold")
    table = Table.grid(*columns, padding=(0, 2))
    rows: list[tuple[str, Text]] = [
        ("model", Text(printable(model.name) or "without a name", style="bold")),
        ("file", Text(str(model.path))),
        ("description", Text(printable(model.description))),
        ("made by", Text(printable(model.generation_tool))),
        ("version", Text(model.fmi_version if model.system else f"FMI {model.fmi_version}")),
        *((kind.value, _interface(interface)) for kind, interface in model.interfaces.items()),
        ("platforms", _platforms(model)),
        ("size", Text(_size(model))),
        ("experiment", Text(_experiment(model))),
        ("sha256", Text(sha256, style="dim")),
    ]
    for name, text in rows:
        if text.plain:
            table.add_row(name, text)
    return table


def _interface(interface: Interface) -> Text:
    words = [
        f"{name} = {value}" if value != "true" else name for name, value in interface.flags.items()
    ]
    text = Text(printable(interface.identifier, 60))
    text.append(f"\n{', '.join(words)}" if words else "", style="dim")
    if interface.needs_execution_tool:
        text.append("\nneeds the tool that made it on this machine", style="yellow")
    return text


def _platforms(model: Model) -> Text:
    """Return all platforms, and whether this one is among them."""
    text = Text(printable(", ".join(model.platforms)) or "none")
    if model.system is not None:
        return text  # of all parts
    for kind, interface in model.interfaces.items():
        try:
            member = binary_of(model, interface)
        except FmuPlatformError as error:
            reason = str(error).removeprefix(f"{model.path}: ")
            text.append(f"\n{kind} does not run on {this_platform()}: {reason}", style="bold red")
        else:
            text.append(f"\n{kind} runs here: {printable(member, 80)}", style="green")
    return text


def _size(model: Model) -> str:
    counts = (
        (len(model.variables), "variable"),
        (model.states, "continuous state"),
        (model.event_indicators, "event indicator"),
    )
    return ", ".join(f"{count} {noun}{'s' * (count != 1)}" for count, noun in counts if count)


def _experiment(model: Model) -> str:
    step, tolerance = model.default_step, model.default_tolerance
    words = [
        f"step {step:g} s" if step is not None else "",
        f"tolerance {tolerance:g}" if tolerance is not None else "",
    ]
    return ", ".join(filter(None, words))


# ---- lists ----


def _variables(title: str, variables: Sequence[Variable], shown: int) -> Table:
    table = _list(
        title,
        len(variables),
        shown,
        Column("name", overflow="fold", max_width=34),
        Column("type", style="dim", no_wrap=True),
        Column("unit", no_wrap=True, max_width=12),
        Column("start", justify="right", no_wrap=True, max_width=12),
        Column("description", overflow="fold", style="dim"),
    )
    for variable in variables[:shown]:
        shape = "x".join(map(str, variable.shape))
        no_unit = Text("none", style="yellow") if _wants_unit(variable) else Text("")
        table.add_row(
            Text(printable(variable.name)),
            f"{variable.kind}[{shape}]" if shape else variable.kind,
            Text(printable(variable.unit, 12)) if variable.unit else no_unit,
            Text(printable(variable.start, 12)),
            Text(printable(variable.description, 120)),
        )
    return table


def _wants_unit(variable: Variable) -> bool:
    return variable.is_real and variable.causality in {"input", "output"}


def _units(model: Model, names: Sequence[str], shown: int) -> Table:
    headings = [Column(heading, no_wrap=True) for heading in ("unit", "is", "in SI")]
    table = _list("Units", len(names), shown, *headings, Column(style="dim", no_wrap=True))
    for name in names[:shown]:
        declared = model.units.get(name, Unit(name))
        unit = to_si(declared)
        if unit.dimension is None:
            row = (Text("unknown", style="yellow"), Text(""), "give it in the profile")
        else:
            offset = f" {unit.offset:+.6g}" if unit.offset else ""
            origin = "by its name" if unit is not declared else "as the FMU defines it"
            row = (Text(quantity(unit.dimension)), Text(f"{unit.factor:.6g}{offset}"), origin)
        table.add_row(Text(printable(name, 24)), *row)
    return table


def _findings(found: Sequence[str], shown: int) -> Table:
    title = "Not as the standard wants it (no reason not to run it)"
    table = _list(title, len(found), shown, Column(overflow="fold", style="yellow"))
    table.show_header = False
    for finding in found[:shown]:
        table.add_row(Text(finding))
    return table


def _list(title: str, count: int, shown: int, *columns: Column) -> Table:
    more = f"... and {count - shown} more; --all shows them" if count > shown else None
    return Table(
        *columns,
        title=Text(title, style="bold"),
        title_justify="left",
        caption=more,
        caption_justify="left",
        header_style="dim",
        box=None,
        pad_edge=False,
        padding=(0, 2, 0, 0),
    )


# ---- the draft ----


def _profile(toml: str) -> Text:
    text = Text()
    for line in toml.splitlines():
        code, mark, comment = line.partition("  # ")
        if line.startswith("# ?"):
            text.append(line, style="yellow")
        elif line.startswith("#"):
            text.append(line, style="dim")
        else:
            text.append(code, style="bold" if code.startswith("[") else "")
            text.append(mark + comment, style="dim")
        text.append("\n")
    return text


def _verdict(drafted: Draft | ControllerDraft, draft: Path | None) -> Text:
    doubts = _questions(drafted)
    open_lines = isinstance(drafted, Draft) and drafted.open_lines
    where = f"Draft written to {draft}" if draft is not None else "Draft above"
    if not doubts:
        rest = "; what is marked '# ?' may stay so" if open_lines else ""
        return Text(f"{where}: complete, every guess is sure{rest}.", style="green")
    text = Text(f"{where}: {len(doubts)} open question{'s' * (len(doubts) > 1)}:", style="yellow")
    for doubt in doubts:
        text.append(f"\n  {printable(doubt)}", style="not bold default")
    return text


def _questions(drafted: Draft | ControllerDraft) -> list[str]:
    """Return the open questions of a draft."""
    if isinstance(drafted, Draft):
        return list(drafted.doubts)
    return [doubt for _, doubt in drafted.open]
