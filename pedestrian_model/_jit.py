"""Typed decorators for numba: kernels are compiled with strict IEEE arithmetic.

There is no fast-math, no libm call and no reordering of sums. Each operation is correctly rounded
by the standard, so the same state gives the same bytes on every machine.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, register_jitable
from numpy.typing import NDArray

_Arrays = TypeVar("_Arrays")
_Function = TypeVar("_Function", bound="Callable[..., Any]")
_STRICT: dict[str, Any] = {
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # no kernel is called from C
}


def kernel(function: _Function) -> _Function:
    """Compile ``function`` on its first call, and cache the machine code on disk."""
    return cast("_Function", numba.njit(cache=True, nogil=True, **_STRICT)(function))


def inner(function: _Function) -> _Function:
    """Compile ``function`` with the kernels that call it; from Python it runs uncompiled."""
    return register_jitable(**_STRICT)(function)


def inlined(function: _Function) -> _Function:
    """Compile ``function`` into its callers, so that a loop around it can be vectorised."""
    return register_jitable(forceinline=True, **_STRICT)(function)


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


def _block_pointer(context: Any, builder: Any, array_type: Any, array: Any, at: Any) -> Any:
    """Return the address of a block of eight float64 in a 1-D array."""
    data = context.make_array(array_type)(context, builder, array).data
    block = ir.VectorType(ir.DoubleType(), 8).as_pointer()
    return builder.bitcast(builder.gep(data, [at]), block)


def _copy_block(_typing: Any, to_array: Any, to: Any, array: Any, at: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kinds = signature.args
        target = _block_pointer(context, builder, kinds[0], arguments[0], arguments[1])
        source = _block_pointer(context, builder, kinds[2], arguments[2], arguments[3])
        builder.store(builder.load(source, align=8), target, align=8)
        return context.get_dummy_value()

    return types.void(to_array, to, array, at), generate


def _add_block(_typing: Any, to_array: Any, to: Any, array: Any, at: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kinds = signature.args
        target = _block_pointer(context, builder, kinds[0], arguments[0], arguments[1])
        source = _block_pointer(context, builder, kinds[2], arguments[2], arguments[3])
        total = builder.fadd(builder.load(target, align=8), builder.load(source, align=8))
        builder.store(total, target, align=8)
        return context.get_dummy_value()

    return types.void(to_array, to, array, at), generate


def _uncounted(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """Return an array, or a tuple with arrays, without reference counts."""
    is_tuple = isinstance(kind, types.BaseTuple)
    if is_tuple:
        held = enumerate(kind.types)
        parts = [_uncounted(context, builder, k, builder.extract_value(value, i)) for i, k in held]
        return context.make_tuple(builder, kind, parts)
    if isinstance(kind, types.Array):
        seen = context.make_array(kind)(context, builder, value)
        seen.meminfo = ir.Constant(seen.meminfo.type, None)
        seen.parent = ir.Constant(seen.parent.type, None)
        return seen._getvalue()
    return value


def _borrow(_typing: Any, arrays: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _uncounted(context, builder, signature.args[0], arguments[0])

    return arrays(arrays), generate


#: The same array, or tuple with arrays, without reference counts, for kernels that pass many arrays
#: on. The caller must keep a reference as long as they are used.
borrowed = cast("Callable[[_Arrays], _Arrays]", intrinsic(_borrow))
#: a * b + c, rounded once.
fma = cast("Callable[[float, float, float], float]", intrinsic(_fma))
#: The bits of a float64 as an int64.
bits = cast("Callable[[float], int]", intrinsic(_bits))
#: The float64 of these bits.
from_bits = cast("Callable[[int], float]", intrinsic(_from_bits))
#: to_array[to:to + 8] = array[at:at + 8], as one block and without bounds checks.
copy_block = cast(
    "Callable[[NDArray[np.float64], int, NDArray[np.float64], int], None]", intrinsic(_copy_block)
)
#: to_array[to:to + 8] += array[at:at + 8], as one block and without bounds checks.
add_block = cast(
    "Callable[[NDArray[np.float64], int, NDArray[np.float64], int], None]", intrinsic(_add_block)
)
