"""The outcome of a check: one finding per test."""

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["pass", "warn", "ask", "fail", "skip"]


@dataclass(frozen=True)
class Finding:
    """The outcome of one test.

    Attributes:
        name: Name of the test, a few words.
        verdict: Result: "skip" if the test does not apply or is no longer possible, "ask" if only
            the user can tell.
        text: Result with numbers and units, in one line.
        remedy: Advice, ideally the line to add to the profile; empty without advice.
    """

    name: str
    verdict: Verdict
    text: str
    remedy: str = ""
