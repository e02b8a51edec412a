"""Fixtures for the tests of packages that plug into giveway; pytest finds them by itself.

``require_sound_controller(Class, **options)`` and ``require_sound_model(Class, **options)`` fail
and list the rules that a controller or a pedestrian model breaks (docs/plugins.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import pytest


class _Finding(Protocol):
    @property
    def rule(self) -> str: ...

    @property
    def problem(self) -> str: ...


@pytest.fixture
def require_sound_controller() -> Callable[..., None]:
    """Return a check that fails unless a controller (with its ``Options``) obeys all rules."""
    from controller import Setup, check_controller

    setup = Setup(0.05, 1000.0, 100.0, 4.0, 2.0, 5000.0, 2.0)

    def require(kind: Any, **options: Any) -> None:
        _require(check_controller(_maker(kind, options), setup), kind)

    return require


@pytest.fixture
def require_sound_model() -> Callable[..., None]:
    """Return a check that fails unless a pedestrian model obeys all rules."""
    from pedestrian_model import ModelSetup, check_model

    setup = ModelSetup(0.05, 0.27, 5.0, 2.5, 1)

    def require(kind: Any, **options: Any) -> None:
        _require(check_model(_maker(kind, options), setup), kind)

    return require


def _maker(kind: Any, options: dict[str, Any]) -> Callable[[Any], object]:
    """Return a function that makes the plug-in as giveway does."""
    from giveway.plug_ins.options import read_options

    own = read_options(kind.__name__, getattr(kind, "Options", None), options)
    return lambda setup: kind(setup) if own is None else kind(setup, own)


def _require(findings: Sequence[_Finding], kind: Any) -> None:
    broken = [f"{finding.rule}: {finding.problem}" for finding in findings if finding.problem]
    if broken:
        pytest.fail("\n".join([f"{kind.__name__} breaks rules:", *broken]), pytrace=False)
