"""Real runs, shared by the tests that look at them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from giveway import RunResult


@pytest.fixture(scope="session")
def run_once() -> Callable[..., RunResult]:
    """Run a configuration through the real SUMO, FMU and solver; equal ones only once."""
    results: dict[str, RunResult] = {}

    def run(**config: object) -> RunResult:
        key = repr(sorted(config.items()))
        if key not in results:
            import giveway

            # SUMO's own drive is looked at by tests of its own
            results[key] = giveway.run({"sumo.baseline": False} | config)
        return results[key]

    return run


def unseal(folder: Path) -> Path:
    """Turn a results folder into one of an earlier giveway, whose files may be anything."""
    manifest = folder / "manifest.json"
    content = json.loads(manifest.read_text(encoding="utf-8"))
    kept = {key: value for key, value in content.items() if key not in ("seal", "maker")}
    manifest.write_text(json.dumps(kept), encoding="utf-8")
    return folder


def foreign(folder: Path) -> Path:
    """Turn a results folder into one that another user has made, whose key signed it."""
    manifest = folder / "manifest.json"
    content = json.loads(manifest.read_text(encoding="utf-8"))
    manifest.write_text(json.dumps(content | {"maker": "0" * 64}), encoding="utf-8")
    return folder
