"""``[[measure]]`` tables: what is read, and the one line that a mistake is told in."""

import pytest

from giveway.config.files.layers import Layer, build_config, dump_toml, read_toml_text
from giveway.errors import ConfigError

LINE = {"name": "zebra", "line": [[0, 0], [0, 4]]}


def test_written_and_read_again() -> None:
    area = {"name": "middle", "area": [[0, 0], [4, 0], [4, 4]], "interval": 5}
    config = build_config([Layer("file", {"measure": [LINE, area]})])
    again = build_config([read_toml_text(dump_toml(config), "config.toml")])
    assert again.measure == config.measure
    assert [measure.name for measure in again.measure] == ["zebra", "middle"]
    assert all(ego.measure == config.measure for ego in config.each_ego())


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ("here", "expected tables"),
        ([{"line": [[0, 0], [1, 1]]}], "measure[0]: name"),
        ([LINE, LINE], "two have this name"),
        ([{**LINE, "name": "=1+1"}], "name = '=1+1': should not begin with =, +, -, @ or a tab"),
        ([{**LINE, "width": 1}], "unknown key 'width'"),
        ([{"name": "a"}], "either line or area"),
        ([{**LINE, "area": [[0, 0], [1, 0], [1, 1]]}], "either line or area"),
        ([{"name": "a", "line": [[1, 1], [1, 1]]}], "starts and ends at"),
        ([{"name": "a", "line": [[1, 1], [1, 2], [1, 3]]}], "3 point(s)"),
        ([{"name": "a", "line": [[1, 1], [1, "b"]]}], "expected a point [x, y]"),
        ([{"name": "a", "area": [[0, 0], [1, 1]]}], "three corners"),
        ([{"name": "a", "area": [[0, 0], [2, 2], [2, 0], [0, 2]]}], "Self-intersection"),
        ([{"name": "a", "area": [[0, 0], [4, 0], [1, 1], [0, 4]]}], "split it in two"),
        ([{**LINE, "interval": 0}], "at least 0.5"),
    ],
)
def test_a_mistake_is_named_in_one_line(entries: object, words: str) -> None:
    with pytest.raises(ConfigError) as failure:
        build_config([Layer("mine.toml", {"measure": entries})])
    text = str(failure.value)
    assert text.startswith("mine.toml: ")
    assert words in text
    assert "\n" not in text
