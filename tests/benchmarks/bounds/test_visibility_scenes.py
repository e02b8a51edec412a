"""The kernel of visibility beside brute force: the 10,000 scenes that are kept, and a sample."""

from dataclasses import replace

import numpy as np
import pytest
import visibility_scenes as scenes

from giveway.geometry.kernel import Array


def test_the_kernel_agrees_with_rays_in_all_10_000_kept_scenes() -> None:
    rows = scenes.kept()
    assert [row.block for row in rows] == list(range(10_000 // scenes.BLOCK))
    assert sum(row.people for row in rows) == 10_000 * scenes.PEOPLE
    assert sum(row.in_part for row in rows) > 3000
    assert not any(row.wrong for row in rows)
    assert max(row.largest for row in rows) < 3.0 / scenes.RAYS


def test_a_block_of_scenes_compares_as_it_is_kept() -> None:
    assert scenes.compared(7) == scenes.kept()[7]


def test_the_comparison_finds_a_kernel_that_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = scenes.shares

    def with_taller_vehicles(scene: scenes.Scene) -> Array:
        return kernel(replace(scene, tops=scene.tops + 0.1))

    monkeypatch.setattr(scenes, "shares", with_taller_vehicles)
    assert sum(scenes.compared(block).wrong for block in range(2)) > 0


def test_the_campaign_goes_on_where_it_ended(tmp_path, monkeypatch, capsys) -> None:
    file = tmp_path / "scenes.csv"
    monkeypatch.setattr(scenes, "RAYS", 16)
    for count in (50, 100):
        monkeypatch.setattr("sys.argv", ["it", "--scenes", str(count), "--out", str(file)])
        scenes.main()
    assert [row.block for row in scenes.kept(file)] == [0, 1]
    assert "100 scenes, 400 people" in capsys.readouterr().out
    assert np.isfinite([row.largest for row in scenes.kept(file)]).all()
