"""Fixtures for the tests of packages that plug into giveway; pytest finds them by itself.

``require_sound_controller(Class, **options)`` and ``require_sound_model(Class, **options)`` fail
and list the rules that a controller or a pedestrian model breaks (docs/plugins.md). The fixtures
for rules of the road and sensors stand in ``giveway.ego.testing``.
"""

from collections.abc import Callable
from typing import Any

import pytest


@pytest.fixture
def require_sound_controller() -> Callable[..., None]:
    """Return a check that fails unless a controller (with its ``Options``) obeys all rules."""
    from controller import Setup
    from giveway.plug_ins.conformance import check_controller

    return check_of(check_controller, Setup(0.05, 1000.0, 100.0, 4.0, 2.0, 5000.0, 2.0))


@pytest.fixture
def require_sound_model() -> Callable[..., None]:
    """Return a check that fails unless a pedestrian model obeys all rules."""
    from giveway.plug_ins.conformance import check_model
    from pedestrian_model import ModelSetup

    return check_of(check_model, ModelSetup(0.05, 0.27, 5.0, 2.5, 1))


def check_of(findings_of: Callable[..., Any], setup: Any, factory: str = "") -> Callable[..., None]:
    """Return a function that checks a plug-in of one socket, made with its options as in a run.

    Args:
        findings_of: Battery of the socket, called with a maker and ``setup``.
        setup: Setup that a plug-in is made with.
        factory: Name of the class method that makes a plug-in where its class has one; empty if
            the class itself always does.
    """
    from giveway.plug_ins.finding import maker_of
    from giveway.plug_ins.options import read_options

    def require(kind: Any, **options: Any) -> None:
        own = read_options(kind.__name__, getattr(kind, "Options", None), options)
        make = getattr(kind, factory, kind) if factory else kind
        findings = findings_of(maker_of(make, own), setup)
        broken = [f"{finding.rule}: {finding.problem}" for finding in findings if finding.problem]
        if broken:
            pytest.fail("\n".join([f"{kind.__name__} breaks rules:", *broken]), pytrace=False)

    return require
