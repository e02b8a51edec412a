"""numba's ``njit`` for giveway's own kernels, cached on disk, with strict IEEE arithmetic.

The type of the kernels' arrays is defined here, too.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit
from numba.extending import register_jitable
from numpy.typing import NDArray

Array = NDArray[np.float64]
Function = TypeVar("Function", bound=Callable[..., Any])

_STRICT: dict[str, Any] = {
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # no C function, which would be compiled with each kernel
}


def kernel(function: Function) -> Function:
    """Compile ``function`` at its first call; without fastmath, bytes do not depend on the CPU."""
    return cast("Function", njit(cache=True, **_STRICT)(function))


def unlocked(function: Function) -> Function:
    """Compile like :func:`kernel`, but without Python's lock, for several threads."""
    return cast("Function", njit(cache=True, nogil=True, **_STRICT)(function))


def inner(function: Function) -> Function:
    """Compile ``function`` with the kernels that call it, but not for Python.

    Python runs it uncompiled; a function that Python calls should be a kernel.
    """
    return register_jitable(**_STRICT)(function)


def inlined(function: Function) -> Function:
    """Compile ``function`` into its callers."""
    return register_jitable(forceinline=True, **_STRICT)(function)
