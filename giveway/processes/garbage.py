"""When Python looks for garbage: a look at all that exists takes a tenth of a second."""

import contextlib
import gc
from collections.abc import Iterator
from typing import Final

_NEVER: Final = 1 << 30  # collections of the middle generation before one of the oldest


@contextlib.contextmanager
def full_collections_put_off() -> Iterator[None]:
    """No look at all that exists in the meantime; what is new is looked at as ever.

    What exists is not frozen for it: objects that are unfrozen do not count as new ones, so that
    hardly ever a full collection would follow.
    """
    before = gc.get_threshold()
    gc.set_threshold(*before[:2], _NEVER)
    try:
        yield
    finally:
        gc.set_threshold(*before)
