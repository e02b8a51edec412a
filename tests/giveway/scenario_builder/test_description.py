"""A street is described by its TOML file; each mistake in it is one line."""

from pathlib import Path

import pytest

from giveway.errors import ConfigError
from giveway.scenario_builder.description import EXAMPLE, Crossing, Street, read_street


def read(folder: Path, text: str) -> Street:
    file = folder / "street.toml"
    file.write_text(text)
    return read_street(file)


def test_the_example_shows_the_defaults(tmp_path: Path) -> None:
    street = read(tmp_path, EXAMPLE)
    assert street == Street(crossing=(Crossing(position=120.0),))


def test_an_empty_file_is_a_street_without_crossings(tmp_path: Path) -> None:
    assert read(tmp_path, "") == Street()


def test_crossings_are_sorted_from_west_to_east() -> None:
    street = Street(crossing=(Crossing(position=150.0), Crossing(position=60.0)))
    assert [each.position for each in street.crossings] == [60.0, 150.0]


def test_people_are_cleared_at_walking_speed() -> None:
    """Four lanes of 3 m take 10 s at 1.2 m/s; 60 - 3 - 2 - 10 - 10 s are left for vehicles."""
    assert Street(lanes=2, lane_width=3.0).phases == (
        ("G", "r", 35.0),
        ("y", "r", 3.0),
        ("r", "r", 2.0),
        ("r", "G", 10.0),
        ("r", "r", 10.0),
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("lenght = 200.0", r"lenght: unknown key; did you mean 'length'\?"),
        ("length = 5.0", r"length = 5\.0: should be at least 100 \[m\] \(length of the street\)"),
        ("pavement = 0.5", r"pavement = 0\.5: should be 0, or at least 1 \[m\]"),
        ("pavement = true", "pavement = True: should be a number, not true or false"),
        ("[[crossing]]", r"crossing\.0\.position: missing \(distance of its middle"),
        ("[[crossing]]\nposition = 9.0", "0 m and 9 m are 9 m apart; expected crossings 30 m"),
        ("[[crossing]]\nposition = 300.0", r"300 m and 220 m are -80 m apart"),
        ("[[crossing]]\nposition = 90.0\nkind = 'pelican'", "'zebra' or 'signals'"),
        ("pavement = 0\n[[crossing]]\nposition = 90.0", "pavement = 0: a crossing needs a pav"),
        ("[signals]\ncycle = 30.0\nwalk = 20.0", r"signals\.cycle = 30: leaves -1 s of green"),
        ("[demand]\npeople = -1.0", r"demand\.people = -1\.0: should be at least 0"),
        ("crossing = 3", r"crossing = 3: should be"),
        ("length = ", "not valid TOML"),
    ],
)
def test_a_mistake_is_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refused:
        read(tmp_path, text)
    assert str(refused.value).startswith(f"{tmp_path / 'street.toml'}: ")
    assert "\n" not in str(refused.value)
