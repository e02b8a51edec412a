"""Pictures in a report: their text keeps digits and colours."""

from __future__ import annotations

import re

from matplotlib.figure import Figure

from giveway.reports.embedding import inline_svg


def test_text_in_a_picture_keeps_its_digits_and_colours():
    figure = Figure()
    figure.text(0.1, 0.5, "gain = 0.12345, #000000")
    svg = inline_svg(figure, "a")
    assert "gain = 0.12345, #000000" in svg
    assert not re.search(r'="[^"]*\d\.\d{3}', svg)
