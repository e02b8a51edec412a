"""The faults in the code of other packages, in one line each."""

from __future__ import annotations

import traceback
from pathlib import Path

_SHOWN = 80  # Number of characters of a value in a message


def described(error: BaseException) -> str:
    """Return kind, first line and place of an error, like "ValueError: bad (a.py:3)".

    Args:
        error: Error that the code has raised.
    """
    try:
        said = str(error).partition("\n")[0][: 3 * _SHOWN].strip()
    except Exception:
        said = ""
    frames = traceback.extract_tb(error.__traceback__)
    place = f" ({Path(frames[-1].filename).name}:{frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}{f': {said}' if said else ''}{place}"


def shown(value: object) -> str:
    """Return a value as text on one line, whatever its ``repr`` does.

    Args:
        value: Value that the code has returned.
    """
    try:
        text = " ".join(repr(value).split())
    except Exception:
        text = f"a {type(value).__name__}"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
