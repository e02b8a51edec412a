"""Fixtures for tests of packages with rules of the road or sensors: pytest finds them by itself.

``require_sound_rule(Class, **options)`` and ``require_sound_sensor(Class, **options)`` fail with
the checks that a rule of the road or a sensor breaks (docs/plugins.md).
"""

from __future__ import annotations

from collections.abc import Callable

import pytest

from giveway.plug_ins.testing import check_of


@pytest.fixture
def require_sound_rule() -> Callable[..., None]:
    """Return a check that fails unless a rule of the road (with its ``Options``) is sound."""
    from giveway.ego.rules.plug_ins.conformance import check_rule, made_up_route

    return check_of(check_rule, made_up_route(), factory="on")


@pytest.fixture
def require_sound_sensor() -> Callable[..., None]:
    """Return a check that fails unless a sensor (with its ``Options``) is sound."""
    from giveway.ego.perception import SensorSetup
    from giveway.ego.perception.conformance import check_sensor

    return check_of(check_sensor, SensorSetup(0.05, 1, "ego"))
