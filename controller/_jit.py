"""Typed decorators for numba's ``njit``, with a cache on disk and strict IEEE arithmetic."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

Array = NDArray[np.float64]

_Function = TypeVar("_Function", bound="Callable[..., Any]")
_STRICT: dict[str, Any] = {
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # no kernel is called from C
}


def kernel(function: _Function) -> _Function:
    """Compile ``function`` on its first call, without fastmath and reordered sums."""
    return cast("_Function", numba.njit(cache=True, **_STRICT)(function))


def inner(function: _Function) -> _Function:
    """Compile ``function`` with the kernels that call it; from Python it runs uncompiled."""
    return register_jitable(**_STRICT)(function)
