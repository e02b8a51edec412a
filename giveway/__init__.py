"""giveway: how should a vehicle drive through a crowd, and what happens to both?

>>> import giveway
>>> result = giveway.run({"scenario": "shared_space", "crowd": {"pedestrians": 30}, "seed": 1})
>>> result.summary["completion_time"]

The command line is ``giveway``; ``giveway --help`` lists what it does.
"""

from giveway._start import early_signals  # noqa: F401 - the first import: signals are caught from here

# isort: split
from typing import TYPE_CHECKING, Any

from giveway._start.environment import check_rooms, keep_kernels
from giveway._version import __version__
from giveway.errors import GivewayError

if TYPE_CHECKING:
    from giveway.api import run
    from giveway.config import RunConfig
    from giveway.results.run_result import RunResult
    from giveway.studies.interface import study

__all__ = ["GivewayError", "RunConfig", "RunResult", "__version__", "run", "study"]

check_rooms()
keep_kernels()


def __dir__() -> list[str]:
    """Return the public names."""
    return __all__


def __getattr__(name: str) -> Any:
    """Import the API at its first use: numba, pandas and SUMO take seconds to load."""
    if name in {"run", "RunResult"}:
        from giveway import api

        return getattr(api, name)
    if name == "study":
        from giveway.studies.interface import study

        return study
    if name == "RunConfig":
        from giveway.config import RunConfig

        return RunConfig
    raise AttributeError(f"module 'giveway' has no attribute '{name}'")
