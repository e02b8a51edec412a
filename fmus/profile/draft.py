"""The draft of a vehicle profile: certain settings, open questions, and the file with both."""

import re
from collections.abc import Container
from dataclasses import dataclass
from typing import Any, Final

from fmus.description.model import Model
from fmus.text import printable

Text = bool | int | float | str | tuple[str, ...]

SHOWN: Final = 20  # parameters in the file
BARE: Final = re.compile(r"[A-Za-z0-9_-]+")


@dataclass(frozen=True)
class Line:
    """A key of a table."""

    key: str
    value: Text
    comment: str = ""
    sure: bool = True

    def __str__(self) -> str:
        comment = f"  # {printable(self.comment, 80)}" if self.comment else ""
        return f"{'' if self.sure else '# ? '}{self.key} = {toml_value(self.value)}{comment}"


@dataclass(frozen=True)
class Entry:
    """A table of the profile, certain or open.

    Attributes:
        table: Name of the table, such as ``inputs.force``.
        why: Evidence for it.
        doubt: Open decision; empty if there is none.
        sure: True if the table belongs to the draft, even if one of its lines is a question.
    """

    table: str
    lines: tuple[Line, ...]
    why: str = ""
    doubt: str = ""
    sure: bool = True

    @property
    def confident(self) -> bool:
        """Return whether the table can be used as it is."""
        return self.sure and not self.doubt

    def __str__(self) -> str:
        head = [f"# {printable(note, 160)}" for note in (self.why, self.doubt) if note]
        mark = "" if self.sure else "# ? "
        body = (str(line) for line in self.lines)
        rows = (row if row.startswith("# ?") else mark + row for row in body)
        return "\n".join([*head, f"{mark}[{self.table}]", *rows])


@dataclass(frozen=True)
class Draft:
    """A drafted profile.

    Attributes:
        entries: Entries in the order of the file.
        remarks: Further remarks for the user.
    """

    model: Model
    entries: tuple[Entry, ...]
    remarks: tuple[str, ...] = ()

    @property
    def confident(self) -> bool:
        """Return whether nothing is open, so that the draft is a profile."""
        return all(entry.confident for entry in self.entries)

    @property
    def doubts(self) -> list[str]:
        """The open decisions, one phrase for each table."""
        return [f"[{entry.table}] {entry.doubt}" for entry in self.entries if entry.doubt]

    @property
    def open_lines(self) -> bool:
        """Return whether any line is marked as open, even an optional one."""
        return any(not (e.sure and all(line.sure for line in e.lines)) for e in self.entries)

    @property
    def values(self) -> dict[str, Any]:
        """Return the certain settings as the profile's nested tables."""
        values: dict[str, Any] = {}
        for entry in self.entries:
            if entry.sure:
                table = values
                for part in entry.table.split("."):
                    table = table.setdefault(part, {})
                table.update({line.key: line.value for line in entry.lines if line.sure})
        return values

    @property
    def toml(self) -> str:
        """Return the draft as a file."""
        head = [
            f"# Vehicle profile of {printable(self.model.path.name, 100)}, drafted from what the "
            "FMU says about itself."
        ]
        if self.open_lines:
            head.append('# Lines with "# ?" are open: decide them, and take away the "# ?".')
        head += [f"# {printable(remark, 160)}" for remark in self.remarks]
        taken = {line.value for entry in self.entries for line in entry.lines}
        blocks = ["\n".join(head), *map(str, self.entries), *_parameters(self.model, taken)]
        return "\n\n".join(blocks) + "\n"


def toml_key(name: str) -> str:
    """Return a key as TOML writes it."""
    return name if BARE.fullmatch(name) else toml_value(name)


def toml_value(value: Text) -> str:
    """Return a value as TOML writes it."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'
    return repr(value)


def _parameters(model: Model, taken: Container[Text]) -> list[str]:
    """Return the FMU's parameters with their values, as comments that a user can activate."""
    free = [
        v
        for v in model.variables.values()
        if v.settable and v.causality == "parameter" and v.is_real and not v.shape and v.start
        if v.name not in taken
    ]
    if not free:
        return []
    rows = [
        "# Parameters, in the FMU's own units; take away the # to change one.",
        "# [parameters]",
    ]
    for variable in free[:SHOWN]:
        words = f"{variable.unit}: {variable.description}".strip(": ")
        line = Line(toml_key(variable.name), float(variable.start), words)
        rows.append(f"# {line}")
    if len(free) > SHOWN:
        rows.append(f"# ... and {len(free) - SHOWN} more: giveway fmu inspect --all")
    return ["\n".join(rows)]
