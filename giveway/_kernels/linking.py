"""Machine code for functions that Python calls, and for no others.

Numba optimises each function that it compiles together with all functions that it calls, and makes
machine code of it. It does both once more for each caller: six times for a function five calls
deep. A function without an entry for Python is called by compiled code alone, which has a copy of
it. Therefore such a function is only linked here with the functions that it calls, until its
address is needed after all. Numba's own helpers are such functions, and ours that are ``inner`` or
``inlined``.

Importing this module makes the changes. It reaches into numba, hence ``cache.LINKED``.
The kernels' results do not change, because the optimiser's arithmetic is strict in any case.
"""

from typing import Any

from numba.core import codegen

_PYTHON = "_ZN7cpython"  # numba's name of the entry for Python, before the function's own name

_Library: Any = codegen.CPUCodeLibrary
_JitLibrary: Any = codegen.JITCodeLibrary
_Codegen: Any = codegen.JITCPUCodegen
_finalize_as_ever: Any = _Library.finalize
_serialize_as_ever: Any = _Library.serialize_using_object_code
_address_as_ever: Any = _JitLibrary.get_pointer_to_function
_translate_as_ever: Any = _JitLibrary._finalize_specific
_set_environment_as_ever: Any = _Codegen.set_env

_environments: dict[str, Any] = {}  # environments of functions that no machine code refers to yet


def _defined(module: Any) -> set[str]:
    return {function.name for function in module.functions if not function.is_declaration}


def _finalize(library: Any) -> None:
    """Link a function with those that it calls; optimise and translate it only for Python."""
    ours = isinstance(library, _JitLibrary)
    if not ours or any(name.startswith(_PYTHON) for name in _defined(library._final_module)):
        _finalize_as_ever(library)
        return
    library._raise_if_finalized()
    for linked in dict.fromkeys(library._linking_libraries):
        library._reload_init.update(linked._reload_init)
        library._final_module.link_in(linked._get_module_for_linking(), preserve=True)
    library._finalize_dynamic_globals()
    library._finalized = library._only_linked = True


def _translate_after_all(library: Any) -> None:
    if getattr(library, "_only_linked", False):
        library._only_linked = False
        library._optimize_final_module()
        library._final_module.verify()
        library._finalize_final_module()


def _address(library: Any, name: str) -> Any:
    library._ensure_finalized()
    if getattr(library, "_only_linked", False) and name not in _defined(library._final_module):
        return 0  # numba's value for a missing entry
    _translate_after_all(library)
    return _address_as_ever(library, name)


def _serialize(library: Any) -> Any:
    library._ensure_finalized()
    _translate_after_all(library)
    return _serialize_as_ever(library)


def _set_environment(generator: Any, name: str, environment: Any) -> None:
    """Tell machine code the environment of a function, or remember it until there is some."""
    if generator._engine.is_symbol_defined(name):
        _set_environment_as_ever(generator, name, environment)
    else:
        _environments[name] = environment


def _translate(library: Any) -> None:
    _translate_as_ever(library)
    for variable in library._final_module.global_variables:
        if variable.name in _environments:
            library._codegen.set_env(variable.name, _environments.pop(variable.name))


_Library.finalize = _finalize
_Library.serialize_using_object_code = _serialize
_JitLibrary.get_pointer_to_function = _address
_JitLibrary._finalize_specific = _translate
_Codegen.set_env = _set_environment
