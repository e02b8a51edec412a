"""The faults in the code of other packages, in one line each."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

_Entry = TypeVar("_Entry", bound=np.generic)

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


@contextmanager
def blamed(name: str, kind: type[Exception], when: str = "") -> Iterator[None]:
    """Turn whatever is raised in this context into an error that names the plug-in.

    Args:
        name: Name of the plug-in, for the message.
        kind: Kind of the error; one of this kind keeps its own words.
        when: Words for the occasion, like " when it was made".
    """
    try:
        yield
    except kind as error:
        raise kind(f"{name}: {error}") from error
    except (Exception, SystemExit) as error:
        raise kind(f"{name} raised {described(error)}{when}") from error


def read_only(array: NDArray[_Entry]) -> NDArray[_Entry]:
    """Return a view of an array that cannot be written."""
    view = array.view()
    view.flags.writeable = False
    return view
