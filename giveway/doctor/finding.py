"""One finding of the doctor."""

from dataclasses import dataclass
from typing import Literal

Level = Literal["ok", "note", "warning", "error"]


@dataclass(frozen=True)
class Finding:
    """What was looked at, what was found, and what to do about it.

    Attributes:
        level: ``error`` stops a run, ``warning`` may spoil one, ``note`` is good to know.
        subject: what was looked at, two or three words.
        text: what was found, one line.
        remedy: what to do; empty where there is nothing to do.
    """

    level: Level
    subject: str
    text: str
    remedy: str = ""


def ok(subject: str, text: str) -> Finding:
    """A finding that all is well."""
    return Finding("ok", subject, text)


def note(subject: str, text: str, remedy: str = "") -> Finding:
    """A finding that is good to know."""
    return Finding("note", subject, text, remedy)


def warning(subject: str, text: str, remedy: str) -> Finding:
    """A finding that may spoil a run."""
    return Finding("warning", subject, text, remedy)


def error(subject: str, text: str, remedy: str) -> Finding:
    """A finding that stops a run."""
    return Finding("error", subject, text, remedy)
