"""Numba's compiler without what it does that nobody here reads.

The code that comes out is the same. To import this module is to do so; it reaches into numba, hence
``cache.LINKED``.
"""

from typing import Any

from llvmlite import ir
from llvmlite.binding import ffi
from numba.core import codegen, cpu
from numba.core.targetconfig import TargetConfig

_Library: Any = codegen.CPUCodeLibrary
_Target: Any = cpu.CPUContext
_Type: Any = ir.Type
_Configuration: Any = TargetConfig
_for_c_as_ever: Any = _Target.create_cfunc_wrapper
_size_as_ever: Any = _Type.get_abi_size

_sizes: dict[tuple[str, str], int] = {}  # by the data layout and the type


def _optimize_functions(library: Any, module: Any) -> None:
    """Prepare what the module defines, not what it only declares, which is nine of ten."""
    module.data_layout = library._codegen._data_layout
    for function in module.functions:
        if not function.is_declaration:
            passes, builder = library._codegen._function_pass_manager()
            passes.run(function, builder)


def _size(kind: Any, target_data: Any, context: Any = None) -> int:
    """A type's size; numba has a module parsed for each time that it asks."""
    key = str(target_data), str(kind)
    if key not in _sizes:
        _sizes[key] = _size_as_ever(kind, target_data, context)
    return _sizes[key]


def _for_c(target: Any, library: Any, description: Any, *rest: Any) -> None:
    """Make the entry for C, but of numba's own helpers, which only compiled code calls."""
    if not description.modname.startswith("numba."):
        _for_c_as_ever(target, library, description, *rest)


def _equal(one: Any, other: Any) -> Any:
    """Compare what is set in either; numba looks at all options, a hundred thousand times."""
    if not isinstance(other, TargetConfig):
        return NotImplemented
    if type(one) is not type(other):
        return bool(one.values() == other.values())  # type: ignore[no-untyped-call]
    if one._values == other._values:
        return True
    either = one._values.keys() | other._values.keys()
    return all(getattr(one, name) == getattr(other, name) for name in either)


def _tell_nobody() -> None:
    """Of each call of LLVM, a hundred thousand, numba tells its timers twice; nobody reads them."""
    for told in list(ffi.lib._lock._cblist):
        if all(one.__module__ == "numba.core.base" for one in told):
            ffi.unregister_lock_callback(*told)


_tell_nobody()
_Library._optimize_functions = _optimize_functions
_Type.get_abi_size = _size
_Target.create_cfunc_wrapper = _for_c
_Configuration.__eq__ = _equal
