"""The reference figure: the speeds that the controllers aim at, over the gap."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from controller import Pid, TunedPid
from giveway.cli.commands.plot_command import reference_command
from giveway.errors import ConfigError
from giveway.figures import reference_figure

if TYPE_CHECKING:
    from pathlib import Path


def test_it_draws_the_curves_that_it_is_given():
    curves = [("a", Pid().reference_speed), ("b", TunedPid().reference_speed)]
    (axes,) = reference_figure(curves, safe_distance=8.0, buffer_distance=10.0).axes
    drawn = {line.get_label(): line for line in axes.lines}
    gaps, paper = drawn["a"].get_data()
    assert gaps[0] == 0.0
    assert gaps[-1] > 18.0
    np.testing.assert_allclose(paper, 4.0 * np.clip((gaps - 8.0) / 10.0, 0.0, 1.0))
    tuned = drawn["b"].get_ydata()
    assert (tuned >= paper - 0.1).all()
    assert tuned[-1] == 4.0
    assert any("8 m" in text.get_text() for text in axes.texts)
    for wrong in ([], 3 * curves[:1]):
        with pytest.raises(ValueError, match="pass one or two"):
            reference_figure(wrong, safe_distance=8.0, buffer_distance=10.0)


def test_the_command_writes_it(tmp_path: Path):
    reference_command(tmp_path / "f.png")
    assert (tmp_path / "f.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ConfigError, match=r"--out .*f\.txt: expected a name that ends with \.png"):
        reference_command(tmp_path / "f.txt")
