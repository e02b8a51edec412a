"""The figure of pairs: each run against its partner."""

from __future__ import annotations

import numpy as np

from giveway.figures.studies.study_pairs import PairSide, pair_figure


def lines(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


class TestPairs:
    """Both runs of a pair, side by side."""

    def test_speed_reference_gap_force_and_who_acts(self, run):
        sides = [PairSide(n, run(30, 1, n)[0], 8.0, 10.0) for n in ("mpc", "pid")]
        figure = pair_figure(sides, title="seed 1")
        grid = np.array(figure.axes).reshape(3, 2)
        for (speed, gap, force), side in zip(grid.T, sides, strict=True):
            assert speed.get_title() == side.label
            np.testing.assert_array_equal(lines(speed, "speed")[0].get_ydata(), side.ego.speed)
            reference = lines(speed, "reference speed")[0].get_ydata()
            np.testing.assert_array_equal(reference, side.ego.reference_speed)
            drawn, seen = lines(gap, "gap")[0].get_ydata(), np.isfinite(side.ego.gap)
            np.testing.assert_array_equal(drawn[np.isfinite(drawn)], side.ego.gap[seen])
            assert lines(gap, "d_safe")[0].get_ydata() == [8.0, 8.0]
            np.testing.assert_array_equal(
                lines(force, "force")[0].get_ydata(), side.ego.force / 1000.0
            )
            assert {patch.get_label() for patch in gap.patches} == set(side.ego.controller)
        assert len({axes.get_xlim() for axes in grid.flat}) == 1
        assert grid[1, 0].get_ylim() == grid[1, 1].get_ylim()
        assert grid[2, 0].get_ylim() == grid[2, 1].get_ylim()

    def test_each_side_has_its_own_distances(self, run):
        ego = run(5, 1, "pid")[0]
        figure = pair_figure([PairSide("a", ego, 4.0, 10.0), PairSide("b", ego, 12.0, 1.0)])
        safe = [lines(axes, "d_safe")[0].get_ydata()[0] for axes in figure.axes[2:4]]
        assert safe == [4.0, 12.0]
