"""numba's ``njit`` with types: cached on disk, strict IEEE arithmetic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar, cast

import numba

if TYPE_CHECKING:
    from collections.abc import Callable

_Function = TypeVar("_Function", bound="Callable[..., Any]")


def kernel(function: _Function) -> _Function:
    """Compile ``function`` on its first call; no fastmath, no reordered sums."""
    return cast("_Function", numba.njit(cache=True, error_model="numpy")(function))
