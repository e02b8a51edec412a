"""The outcome of a check: one finding per test."""

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["pass", "warn", "ask", "fail", "skip"]


@dataclass(frozen=True)
class Finding:
    """The outcome of one test.

    Attributes:
        name: Name of the test, a few words.
        verdict: "skip" where the test does not apply, or could not be tried any more; "ask" where
            only the user can tell.
        text: what was found, with numbers and units; one line.
        remedy: what to do, ideally the line to add to the profile; empty if nothing.
    """

    name: str
    verdict: Verdict
    text: str
    remedy: str = ""
