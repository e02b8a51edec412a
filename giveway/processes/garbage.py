"""The schedule of Python's garbage collection: a full collection takes a tenth of a second."""

import contextlib
import gc
from collections.abc import Iterator
from typing import Final

# Numbers of new objects after which Python collects garbage, for its three generations
_SELDOM: Final = (50_000, 20, 100)
_NEVER: Final = 1 << 30  # Number of collections of the middle generation before a full one


@contextlib.contextmanager
def rarely_collected() -> Iterator[None]:
    """Collect garbage rarely in this context: of what imports and a compiler make, most stays."""
    before = gc.get_threshold()
    gc.set_threshold(*_SELDOM)
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextlib.contextmanager
def full_collections_put_off() -> Iterator[None]:
    """Postpone full collections in this context; new objects are collected as usual.

    Existing objects are not frozen for this. Objects that are unfrozen later do not count as new
    ones, so that a full collection would hardly ever follow.
    """
    before = gc.get_threshold()
    gc.set_threshold(*before[:2], _NEVER)
    try:
        yield
    finally:
        gc.set_threshold(*before)
