"""Measured impact speeds: a CSV file of the user's, right and wrong."""

from __future__ import annotations

import pytest

from giveway.errors import ConfigError
from giveway.ncap.measured import read_measured
from giveway.ncap.protocol import read_protocol

PROTOCOL = read_protocol("euroncap-2026")
HEAD = "test,hit_point,speed,relative_speed\n"


def read(folder, text):
    file = folder / "track.csv"
    file.write_text(text, encoding="utf-8")
    return read_measured(file, PROTOCOL)


def test_cells_are_read_by_name_and_other_columns_are_ignored(tmp_path):
    text = "note,test,hit_point,speed,relative_speed\nwet,CPNA,50,60,12.5\n,CPLA,25,70,0\n"
    assert read(tmp_path, text) == {("CPNA", 50, 60): 12.5, ("CPLA", 25, 70): 0.0}


def test_a_table_of_giveway_is_read_without_other_drivers_nobody_and_failures(tmp_path):
    text = (
        f"driver,{HEAD}speed-holder,CPNA,50,60,3.25\nspeed-holder,CPNA,50,50,\n"
        "speed-holder,nobody,0,60,0.0\nmpc,CPNA,50,60,9.0\n"
    )
    assert read(tmp_path, text) == {("CPNA", 50, 60): 3.25}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("test,speed\nCPNA,10\n", "track.csv: line 2: no hit_point; expected test, hit_point"),
        (HEAD + "CPNA,33,10,0\n", "line 2: CPNA 33 % 10 km/h: no cell of Euro NCAP 2026"),
        (HEAD + "CPTA,50,10,0\n", "no cell of Euro NCAP 2026; expected a test of CPFA, CPLA"),
        (HEAD + "CPNA,50,10,fast\n", "relative_speed = 'fast': expected a number, 0 or above"),
        (HEAD + "CPNA,50,10,-1\n", "relative_speed = '-1': expected a number, 0 or above"),
        (HEAD + "CPNA,50,10,inf\n", "relative_speed = 'inf': expected a number"),
    ],
)
def test_a_wrong_file_is_one_line(tmp_path, text, said):
    with pytest.raises(ConfigError) as error:
        read(tmp_path, text)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_missing_file_is_one_line(tmp_path):
    with pytest.raises(ConfigError, match="No such file or directory"):
        read_measured(tmp_path / "none.csv", PROTOCOL)
