"""One finding of the doctor."""

from dataclasses import dataclass
from typing import Literal

Level = Literal["ok", "note", "warning", "error"]


@dataclass(frozen=True)
class Finding:
    """A finding: what was examined, the result, and the advice.

    Attributes:
        level: ``error`` stops a run, ``warning`` may spoil one, ``note`` is good to know.
        subject: Examined thing, in two or three words.
        text: Result, in one line.
        remedy: Advice; empty if there is nothing to do.
    """

    level: Level
    subject: str
    text: str
    remedy: str = ""


def ok(subject: str, text: str) -> Finding:
    """Return a finding that all is well."""
    return Finding("ok", subject, text)


def note(subject: str, text: str, remedy: str = "") -> Finding:
    """Return a finding that is good to know."""
    return Finding("note", subject, text, remedy)


def warning(subject: str, text: str, remedy: str) -> Finding:
    """Return a finding that may spoil a run."""
    return Finding("warning", subject, text, remedy)


def error(subject: str, text: str, remedy: str) -> Finding:
    """Return a finding that stops a run."""
    return Finding("error", subject, text, remedy)
