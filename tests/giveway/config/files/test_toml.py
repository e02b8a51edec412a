"""Whatever a TOML file of a user's holds, one line tells what is wrong with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fmus import FmuProfileError, read_profile
from giveway.config.files.layers import read_toml
from giveway.config.files.presets import parameters_of
from giveway.config.files.toml import parse_toml, read_toml_file
from giveway.errors import ConfigError
from giveway.recordings.dataset import dataset_of
from giveway.studies.definition import read_definition
from sumo_scenarios import ScenarioError, find


def scenario_beside(settings: Path) -> object:
    config = settings.with_name("mine.sumocfg")
    config.touch()
    settings.rename(settings.with_name("mine.giveway.toml"))
    return find(config)


READERS: dict[str, tuple[Callable[[Path], object], type[Exception]]] = {
    "settings": (read_toml, ConfigError),
    "preset": (lambda file: parameters_of(str(file)), ConfigError),
    "study": (read_definition, ConfigError),
    "data set": (lambda file: dataset_of(str(file)), ConfigError),
    "profile": (read_profile, FmuProfileError),
    "scenario": (scenario_beside, ScenarioError),
}
BROKEN = {
    "a row of brackets": f"name = {'[' * 3000}{']' * 3000}\n",
    "thousands of digits": f"name = {'9' * 5000}\n",
    "no TOML": "name =\n",
}


@pytest.mark.parametrize("text", BROKEN.values(), ids=BROKEN)
@pytest.mark.parametrize(("read", "error"), READERS.values(), ids=READERS)
def test_every_reader_says_it_in_one_line(tmp_path: Path, refused, read, error, text: str) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with refused(error, "mine"):
        read(file)


def test_deep_nesting_is_refused_before_anything_walks_it() -> None:
    def text(levels: int) -> str:
        return f"a = {'[{b = ' * levels}1{'}]' * levels}"

    parse_toml(text(9), "mine.toml")
    with pytest.raises(ConfigError, match=r"mine\.toml: .* more than 20 deep"):
        parse_toml(text(40), "mine.toml")


@pytest.mark.parametrize(
    ("content", "said"), [(None, "no such file"), (b"a = '\xff'", "not UTF-8 text")]
)
def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, content, said: str) -> None:
    file = tmp_path / "mine.toml"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(ConfigError, match=rf"mine\.toml: .*{said}.*; expected a preset \(TOML\)"):
        read_toml_file(file, "a preset")
