"""The one file that imports libsumo."""

from __future__ import annotations

from typing import Any

from giveway.errors import InstallationError


def import_libsumo() -> Any:
    """The module, which has no types.

    Raises:
        InstallationError: it cannot be imported.
    """
    try:
        import libsumo
    except ImportError as error:
        raise InstallationError(
            f"libsumo cannot be imported ({error}); reinstall with: pip install giveway"
        ) from error
    return libsumo


def direct(sumo: Any, domain: str, function: str) -> Any:
    """``sumo.domain.function`` without the wrapper's own call, which takes as long as the answer.

    Args:
        sumo: the libsumo module.
        domain: of SUMO's interface, such as ``vehicle``.
        function: of the domain.
    """
    native = getattr(sumo.libsumo, "_libsumo", None)
    return getattr(native, f"{domain}_{function}", getattr(getattr(sumo, domain), function))


def version() -> str:
    """SUMO's own version string."""
    return str(import_libsumo().simulation.getVersion()[1])
