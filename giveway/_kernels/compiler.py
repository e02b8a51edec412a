"""Numba's compiler without the parts whose results nobody reads here.

The compiled code is the same. Importing this module makes the changes. It reaches into numba, hence
``cache.LINKED``.
"""

from types import CodeType
from typing import Any

from llvmlite import ir
from llvmlite.binding import ffi
from numba.core import codegen, cpu
from numba.core import ir as numba_ir
from numba.core.runtime.context import NRTContext
from numba.core.targetconfig import ConfigStack, TargetConfig
from numba.core.typed_passes import NopythonRewrites
from numba.core.types import Array, StringLiteral
from numba.core.types.functions import BaseFunction
from numba.core.typing.templates import _OverloadFunctionTemplate
from numba.core.untyped_passes import InlineClosureLikes

_Library: Any = codegen.CPUCodeLibrary
_Target: Any = cpu.CPUContext
_Type: Any = ir.Type
_Configuration: Any = TargetConfig
_Flags: Any = ConfigStack
_Template: Any = _OverloadFunctionTemplate
_for_c_as_ever: Any = _Target.create_cfunc_wrapper
_size_as_ever: Any = _Type.get_abi_size
_Instruction: Any = numba_ir.Inst
_Counts: Any = NRTContext
_Function: Any = BaseFunction
_resolve_as_ever: Any = _Function.get_call_type
_Inlining: Any = InlineClosureLikes
_Rewriting: Any = NopythonRewrites
_inline_as_ever: Any = _Inlining.run_pass
_rewrite_as_ever: Any = _Rewriting.run_pass
_count_as_ever: Any = _Counts._call_incref_decref

_ROOMS = ("controller", "giveway", "pedestrian_model")
_INLINED = {"reduce", "stencil", "array"}  # what numba searches for beside closures
_OF_ARRAYS = ("unary", "binop", "call")
_INHERITED = ("nrt", "fastmath", "error_model", "forceinline")  # flags from the caller

_sizes: dict[tuple[str, str], int] = {}  # sizes by the data layout and the type
_kinds: dict[type, type] = {}  # node types that hold variables, and how
_signatures: dict[tuple[int, int], Any] = {}  # by function and context, which are kept
_counted: dict[Any, bool] = {}  # flags by the type


def _optimize_functions(library: Any, module: Any) -> None:
    """Prepare the module's definitions, and not its declarations, which are nine of ten."""
    module.data_layout = library._codegen._data_layout
    for function in module.functions:
        if not function.is_declaration:
            passes, builder = library._codegen._function_pass_manager()
            passes.run(function, builder)


def _size(kind: Any, target_data: Any, context: Any = None) -> int:
    """Return a type's size from a table; numba parses a module each time it asks."""
    key = str(target_data), str(kind)
    if key not in _sizes:
        _sizes[key] = _size_as_ever(kind, target_data, context)
    return _sizes[key]


def _for_c(target: Any, library: Any, description: Any, *rest: Any) -> None:
    """Make the entry for C, except for numba's own helpers, which only compiled code calls."""
    if not description.modname.startswith("numba."):
        _for_c_as_ever(target, library, description, *rest)


def _variables(_instruction: Any, value: Any) -> list[Any]:
    """Return the variables in part of an instruction, in order; numba asks a million times."""
    found: list[Any] = []
    _add_variables(value, found)
    return found


def _add_variables(value: Any, found: list[Any]) -> None:
    kind = _kinds.get(type(value))
    if kind is None:
        bases = (numba_ir.Var, numba_ir.Inst, list, tuple, dict)
        kind = next((base for base in bases if isinstance(value, base)), object)
        _kinds[type(value)] = kind
    if kind is numba_ir.Var:
        found.append(value)
    elif kind is numba_ir.Inst:
        found.extend(value.list_vars())
    elif kind is not object:
        for part in value.values() if kind is dict else value:
            if _kinds.get(type(part)) is not object:
                _add_variables(part, found)


def _resolve(function: Any, context: Any, arguments: Any, keywords: Any) -> Any:
    """Return the signature of a call from a table; numba tries all candidates each time.

    What is written as Python is left to :func:`_implementation`: that notes which one was taken.
    """
    if keywords:
        return _resolve_as_ever(function, context, arguments, keywords)
    _, known = _signatures.setdefault((id(function), id(context)), ((function, context), {}))
    if arguments in known:
        return known[arguments]
    signature = _resolve_as_ever(function, context, arguments, keywords)
    if function._impl_keys[signature.args] is function.typing_key:
        known[arguments] = signature
    return signature


def _implementation(template: Any, arguments: Any, keywords: Any) -> Any:
    """Return a function's implementation for these types, compiled once for equal flags.

    Numba compiles it again wherever the callers differ in any flag.
    """
    flags = _Flags.top_or_none()
    inherited = flags and tuple(str(getattr(flags, name)) for name in _INHERITED)
    key = template.context, tuple(arguments), tuple(keywords.items()), inherited
    if key in template._impl_cache:
        return template._impl_cache[key]
    return template._build_impl(key, arguments, keywords)


def _count(counts: Any, builder: Any, kind: Any, value: Any, name: str) -> None:
    """Count references, but not of numbers and of tuples of numbers."""
    if kind not in _counted:
        model = counts._context.data_model_manager[kind]
        _counted[kind] = model.contains_nrt_meminfo()
    if _counted[kind]:
        _count_as_ever(counts, builder, kind, value, name)


def _inline(passing: Any, state: Any) -> Any:
    """Inline closures, reductions, stencils and arrays of lists where there may be some."""
    code, module = state.func_id.code, state.func_id.modname
    made = any(isinstance(constant, CodeType) for constant in code.co_consts)
    if made or module.split(".")[0] not in _ROOMS or _INLINED.intersection(code.co_names):
        return _inline_as_ever(passing, state)
    return False


def _rewrite(passing: Any, state: Any) -> Any:
    """Rewrite expressions of whole arrays, arrays of lists and keys where there are some."""
    typed = state.typemap
    for block in state.func_ir.blocks.values():
        for one in block.find_insts(numba_ir.Assign):
            if isinstance(one.value, numba_ir.Expr) and (
                one.value.op == "build_list"
                or (one.value.op in _OF_ARRAYS and isinstance(typed[one.target.name], Array))
            ):
                return _rewrite_as_ever(passing, state)
    if any(isinstance(kind, StringLiteral) for kind in typed.values()):
        return _rewrite_as_ever(passing, state)
    return False


def _equal(one: Any, other: Any) -> Any:
    """Compare the options that are set in either; numba compares all, a hundred thousand times."""
    if not isinstance(other, TargetConfig):
        return NotImplemented
    if type(one) is not type(other):
        return bool(one.values() == other.values())  # type: ignore[no-untyped-call]
    if one._values == other._values:
        return True
    either = one._values.keys() | other._values.keys()
    return all(getattr(one, name) == getattr(other, name) for name in either)


def _tell_nobody() -> None:
    """Remove numba's timers, which LLVM calls twice for each of a hundred thousand calls."""
    for told in list(ffi.lib._lock._cblist):
        if all(one.__module__ == "numba.core.base" for one in told):
            ffi.unregister_lock_callback(*told)


_tell_nobody()
_Library._optimize_functions = _optimize_functions
_Type.get_abi_size = _size
_Target.create_cfunc_wrapper = _for_c
_Configuration.__eq__ = _equal
_Instruction._rec_list_vars = _variables
_Function.get_call_type = _resolve
_Template._get_impl = _implementation
_Counts._call_incref_decref = _count
_Inlining.run_pass = _inline
_Rewriting.run_pass = _rewrite
