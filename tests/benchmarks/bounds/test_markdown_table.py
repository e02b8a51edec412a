"""Tables of scripts as Markdown."""

from __future__ import annotations

import pandas as pd
from markdown_table import markdown


def test_missing_numbers_and_first_names_that_repeat_are_empty() -> None:
    rows = {"scene": ["a", "a", "b"], "time [s]": [1.25, float("nan"), 3.0], "hits": [0, 1, 2]}
    head, border, *lines = markdown(pd.DataFrame(rows)).splitlines()
    assert (head, border) == ("| scene | time [s] | hits |", "|---|---|---|")
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    assert cells == [["a", "1.2", "0"], ["", "", "1"], ["b", "3.0", "2"]]
