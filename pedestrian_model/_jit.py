"""The compiler, typed: kernels are numba functions under strict IEEE arithmetic.

No fast-math, no libm call and no reordering of sums: each operation is correctly rounded by the
standard, so the same state gives the same bytes on every machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar, cast

import numba
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

_Function = TypeVar("_Function", bound="Callable[..., Any]")


def kernel(function: _Function) -> _Function:
    """Compile ``function`` on its first call; the machine code is cached on disk."""
    return cast("_Function", numba.njit(cache=True, error_model="numpy", nogil=True)(function))


def inlined(function: _Function) -> _Function:
    """Compile ``function`` into its callers, so that a loop around it can be vectorised."""
    return cast(
        "_Function", numba.njit(cache=True, error_model="numpy", forceinline=True)(function)
    )


def _fma(_typing: Any, a: Any, b: Any, c: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(a, b, c), generate


def _bits(_typing: Any, x: Any) -> Any:
    def generate(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(types.int64))

    return types.int64(x), generate


def _from_bits(_typing: Any, k: Any) -> Any:
    def generate(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(types.float64))

    return types.float64(k), generate


def _add_block(_typing: Any, array: Any, to: Any, at: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        block = ir.VectorType(ir.DoubleType(), 8).as_pointer()
        target = builder.bitcast(builder.gep(data, [arguments[1]]), block)
        source = builder.bitcast(builder.gep(data, [arguments[2]]), block)
        total = builder.fadd(builder.load(target, align=8), builder.load(source, align=8))
        builder.store(total, target, align=8)
        return context.get_dummy_value()

    return types.void(array, to, at), generate


#: a * b + c, rounded once: one instruction, and the same result wherever it runs.
fma = cast("Callable[[float, float, float], float]", intrinsic(_fma))
#: The bits of a float64 as an int64.
bits = cast("Callable[[float], int]", intrinsic(_bits))
#: The float64 of these bits.
from_bits = cast("Callable[[int], float]", intrinsic(_from_bits))
#: array[to:to + 8] += array[at:at + 8], eight sums at once: a loop of eight stays scalar.
add_block = cast("Callable[[NDArray[np.float64], int, int], None]", intrinsic(_add_block))
