"""The one file that imports libsumo."""

import sys
from typing import Any, Final

from giveway._start.environment import out_of_memory
from giveway.errors import InstallationError

_SPARED: Final = ("numpy", "pyproj", "lxml")  # Optional imports of libsumo's Python modules


def import_libsumo() -> Any:
    """Import and return libsumo, which has no types.

    Raises:
        InstallationError: libsumo cannot be imported.
    """
    try:
        import libsumo
    except ImportError as error:
        remedy = "reinstall with: pip install giveway"
        if out_of_memory(error):
            remedy = "free memory, or raise the limit (ulimit -v)"
        raise InstallationError(f"libsumo cannot be imported ({error}); {remedy}") from error
    return libsumo


def import_bare_libsumo() -> Any:
    """Return libsumo without the optional imports of its tools, which a child does not need.

    Modules that are imported already are kept.

    Raises:
        InstallationError: libsumo cannot be imported.
    """
    modules: dict[str, Any] = sys.modules
    left_out = [name for name in _SPARED if name not in modules]
    modules.update(dict.fromkeys(left_out))
    try:
        return import_libsumo()
    except InstallationError:
        for name in left_out:
            del modules[name]
        return import_libsumo()


def direct(sumo: Any, domain: str, function: str) -> Any:
    """Return ``sumo.domain.function`` without its Python wrapper.

    Args:
        sumo: The libsumo module.
        domain: Domain of SUMO's interface, such as ``vehicle``.
        function: Function of the domain.
    """
    native = getattr(sumo.libsumo, "_libsumo", None)
    return getattr(native, f"{domain}_{function}", getattr(getattr(sumo, domain), function))


def is_refusal(error: BaseException) -> bool:
    """Return whether an error is SUMO's answer to a call that it could not carry out."""
    sumo = import_libsumo()
    # they have no common base class
    return isinstance(error, (sumo.TraCIException, sumo.FatalTraCIError))


def version() -> str:
    """The version text of SUMO."""
    return str(import_libsumo().simulation.getVersion()[1])
