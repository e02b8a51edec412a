"""Mutants: drawn in one tree, found again in another.

A mutant is named by package, function, operator and the text of its line, and not by its file: it
outlives moves of modules, and with a list of renames also those of functions and classes.
"""

from __future__ import annotations

import random
import re
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mutants_functions import PACKAGES, Function

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mutants_sites import Site


@dataclass(frozen=True)
class Mutant:
    """A fault in a function.

    Attributes:
        package: the import package.
        function: its name, with those of classes and functions round it.
        operator: the fault.
        line: the text of the line that has it.
        ordinal: which one of the same operator in lines of this text.
        place: which one of the same operator in the function, for lines that were rewritten.
        places: how many of the same operator the function has.
    """

    package: str
    function: str
    operator: str
    line: str
    ordinal: int
    place: int
    places: int

    @property
    def name(self) -> str:
        """What a person needs to find it."""
        return f"{self.package}:{self.function} | {self.operator} #{self.ordinal} | {self.line}"


@dataclass(frozen=True)
class Placed:
    """Where a mutant stands in a tree.

    Attributes:
        function: that has it.
        site: that is changed.
        exact: whether the line's text is the same; else the operator's place in the function is.
    """

    function: Function
    site: Site
    exact: bool


class NoPlaceError(Exception):
    """The mutant has none in this tree: its message is ``gone`` or ``ambiguous``."""


def draw(functions: Sequence[Function], count: int, seed: int) -> list[Mutant]:
    """Mutants of as many functions, each package with a share as its share of the functions.

    In a function each kind of fault is as likely as any other, however many sites it has; a
    dropped return value, which nearly any test finds, is only drawn where there is nothing else.
    """
    generator = random.Random(seed)
    names = Counter((f.package, f.name) for f in functions)
    able = [f for f in functions if f.sites and names[f.package, f.name] == 1]
    drawn: list[Mutant] = []
    for package, share in _shares(Counter(f.package for f in able), count).items():
        of_package = sorted((f for f in able if f.package == package), key=lambda f: f.name)
        for function in generator.sample(of_package, share):
            kinds = {s.operator.split()[0] for s in function.sites}
            kind = generator.choice(sorted(kinds - {"return"}) or ["return"])
            sites = [s for s in function.sites if s.operator.split()[0] == kind]
            drawn.append(_named(function, generator.choice(sites)))
    return drawn


def _shares(sizes: Counter[str], count: int) -> dict[str, int]:
    """``count`` in parts as large as ``sizes``, whole numbers by the largest remainders."""
    exact = {p: count * sizes[p] / sizes.total() for p in PACKAGES if sizes[p]}
    shares = {p: int(part) for p, part in exact.items()}
    for package in sorted(exact, key=lambda p: shares[p] - exact[p])[
        : count - sum(shares.values())
    ]:
        shares[package] += 1
    return shares


def _named(function: Function, site: Site) -> Mutant:
    alike = [s for s in function.sites if s.operator == site.operator]
    return Mutant(
        function.package,
        function.name,
        site.operator,
        site.line,
        site.ordinal,
        alike.index(site),
        len(alike),
    )


class Renames:
    """Names of the old tree and what the new one calls them, one ``old=new`` a line.

    Each is a name, or several joined by dots (``Driver.step=WaitingEgo.step``). They are replaced
    one after the other, in the names of functions and in the texts of lines.
    """

    def __init__(self, text: str = "") -> None:
        lines = (line.partition("#")[0].strip() for line in text.splitlines())
        self._pairs = [line.split("=") for line in lines if line]

    def __call__(self, text: str) -> str:
        """The text with the new names."""
        for old, new in self._pairs:
            text = re.sub(rf"(?<!\w){re.escape(old.strip())}(?!\w)", new.strip(), text)
        return text


def place(mutant: Mutant, functions: Sequence[Function], renames: Renames) -> Placed:
    """Where a mutant stands in a tree: in the same line, or in the same place of the function.

    The latter only if the function has as many sites of the operator as it had.

    Raises:
        NoPlaceError: nowhere, or in several places.
    """
    name, line = renames(mutant.function), renames(mutant.line)
    candidates = [f for f in functions if (f.package, f.name) == (mutant.package, name)]
    exact: list[Placed] = []
    near: list[Placed] = []
    for function in candidates:
        alike = [s for s in function.sites if s.operator == mutant.operator]
        same = [s for s in alike if (s.line, s.ordinal) == (line, mutant.ordinal)]
        exact += [Placed(function, site, exact=True) for site in same]
        if len(alike) == mutant.places:
            near += [Placed(function, alike[mutant.place], exact=False)]
    found = exact or near
    if len(found) != 1:
        raise NoPlaceError("ambiguous" if found else "gone")
    return found[0]
