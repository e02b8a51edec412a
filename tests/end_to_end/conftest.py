"""Real runs, shared by the tests that look at them."""

from collections.abc import Callable

import pytest

import giveway
from giveway.api import RunResult


@pytest.fixture(scope="session")
def run_once() -> Callable[..., RunResult]:
    """Run a configuration through the real SUMO, FMU and solver; equal ones only once."""
    results: dict[str, RunResult] = {}

    def run(**config: object) -> RunResult:
        key = repr(sorted(config.items()))
        if key not in results:
            results[key] = giveway.run(config)
        return results[key]

    return run
