"""numba's ``njit`` for giveway's own kernels, cached on disk, with strict IEEE arithmetic.

The type of the arrays that they take stands here, too.
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
    "no_cfunc_wrapper": True,  # none is called from C; it would be compiled with each kernel
}


def kernel(function: Function) -> Function:
    """Compile ``function`` at its first call; without fastmath bytes do not depend on the CPU."""
    return cast("Function", njit(cache=True, **_STRICT)(function))


def unlocked(function: Function) -> Function:
    """As :func:`kernel`, without Python's lock: for what several threads call side by side."""
    return cast("Function", njit(cache=True, nogil=True, **_STRICT)(function))


def inner(function: Function) -> Function:
    """Compile ``function`` with the kernels that call it, and for nobody else.

    From Python it runs as it stands, uncompiled: what Python calls is a kernel.
    """
    return register_jitable(**_STRICT)(function)


def inlined(function: Function) -> Function:
    """Compile ``function`` into its callers: each array that is handed over costs a count of it."""
    return register_jitable(forceinline=True, **_STRICT)(function)
