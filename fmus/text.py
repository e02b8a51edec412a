"""The text of an FMU, made safe for a terminal and a log."""

import unicodedata
from collections.abc import Sequence

LIMIT = 200  # Largest number of characters of a message
_SPACES = frozenset({"Zl", "Zp", "Zs"})


def printable(text: object, limit: int = LIMIT) -> str:
    """Return one line of visible characters, at most ``limit`` long.

    Control characters, direction marks and half surrogates become ``?``: an FMU must be able
    neither to control the terminal nor to break a line.
    """
    words = str(text)[: 4 * limit].split()
    line = "".join(map(_visible, " ".join(words)))
    return line if len(line) <= limit else f"{line[: limit - 3]}..."


def clean(text: str, limit: int) -> str:
    """Do the same as :func:`printable`, but quickly for text that is already clean."""
    return text if len(text) <= limit and text.isprintable() else printable(text, limit)


def listed(names: Sequence[str], shown: int = 6) -> str:
    """Return the first names and the number of the others; an empty text without names."""
    more = f" and {len(names) - shown} more" if len(names) > shown else ""
    return f"{', '.join(names[:shown])}{more}"


def _visible(character: str) -> str:
    category = unicodedata.category(character)
    if category in _SPACES:
        return " "
    return "?" if category.startswith("C") else character
