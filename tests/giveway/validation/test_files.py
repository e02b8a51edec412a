"""The files of comparisons."""

from __future__ import annotations

import pandas as pd
import pytest
from matplotlib.figure import Figure

from giveway.errors import ResultsError
from giveway.validation.files import names_of, write_files


def test_tables_and_pictures_are_written_under_their_names(tmp_path) -> None:
    folder = tmp_path / "new" / "folder"
    write_files(folder, {"a.csv": pd.DataFrame({"x": [0.12345678]})}, {"b": Figure()})
    assert {path.name for path in folder.iterdir()} == names_of(["a.csv"], ["b"])
    assert (folder / "a.csv").read_bytes() == b"x\n0.123457\n"


def test_a_file_in_place_of_the_folder_is_one_line(tmp_path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(ResultsError, match=r"taken: cannot be written .*; name another folder"):
        write_files(tmp_path / "taken", {}, {})
