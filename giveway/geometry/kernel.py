"""numba's ``njit`` for the house's own kernels: cached on disk, strict IEEE arithmetic."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from numba import njit

Function = TypeVar("Function", bound=Callable[..., Any])


def kernel(function: Function) -> Function:
    """Compile ``function`` at its first call; no fastmath: bytes do not depend on the CPU."""
    return cast("Function", njit(cache=True, error_model="numpy")(function))
