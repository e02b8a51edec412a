"""Continuous states: crossings are found, and what cannot be integrated ends the step."""

from __future__ import annotations

from fmus.fmi.continuous import locate


def test_a_crossing_is_found_to_the_resolution():
    at = locate(lambda t: t * t > 2.0, 0.0, 2.0, 1e-12)
    assert 0.0 <= at - 2.0**0.5 <= 1e-12
