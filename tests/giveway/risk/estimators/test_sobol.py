"""Sobol indices of functions whose indices are known."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.risk.estimators.sobol import sobol_indices

GROUPS = {"strong": [0], "weak": [1], "pair": [2, 3], "none": [4]}


def found(function, count=3000):
    asking = sobol_indices(5, GROUPS, count, seed=1)
    vectors = next(asking)
    with pytest.raises(StopIteration) as ended:
        asking.send(function(vectors))
    return {one.group: one for one in ended.value.value}


def test_the_indices_of_a_sum_are_the_shares_of_its_variance():
    indices = found(lambda u: 3.0 * u[:, 0] + u[:, 1] + u[:, 2] + u[:, 3])
    for group, share in (("strong", 9 / 12), ("weak", 1 / 12), ("pair", 2 / 12), ("none", 0.0)):
        one = indices[group]
        assert one.first_low - 0.01 <= share <= one.first_high + 0.01
        assert one.total == pytest.approx(share, abs=0.04)


def test_a_product_is_in_the_total_index_alone():
    indices = found(lambda u: u[:, 0] * u[:, 1])
    assert indices["strong"].first == pytest.approx(0.0, abs=0.1)
    assert indices["strong"].total == pytest.approx(1.0, abs=0.15)
    assert indices["none"].total == pytest.approx(0.0, abs=1e-12)


def test_vectors_without_a_result_are_left_out():
    def failing(u):
        values = u[:, 0].copy()
        values[::10] = np.nan
        return values

    indices = found(failing)
    assert 0 < indices["strong"].used < 3000
    assert indices["strong"].first == pytest.approx(1.0, abs=0.1)


def test_a_constant_criticality_has_no_indices():
    assert np.isnan(found(lambda u: np.zeros(len(u)))["strong"].first)
