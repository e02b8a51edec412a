"""Vehicle FMUs, shipped and foreign, the code that runs them, and the controller as an FMU."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fmus.names import *


def __getattr__(name: str) -> Any:
    """Import all that has a public name at the first use of one: one module alone needs less."""
    if name == "__all__" or not name.startswith("__"):
        names = import_module("fmus.names")
        if name == "__all__" or name in names.__all__:
            return getattr(names, name)
    raise AttributeError(f"module 'fmus' has no attribute '{name}'")
