"""What kills SUMO while it reads costs a child process, once for each content of the files."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import sumo_scenarios
from giveway.errors import SumoError
from giveway.processes import child
from giveway.sumo import first_reading
from giveway.sumo.first_reading import read_first

JUNCTION = Path(sumo_scenarios.__file__).parent / "junction"


@pytest.fixture
def junction(tmp_path: Path) -> Path:
    """A copy of the bundled scenario, which is nobody's own any more."""
    shutil.copytree(JUNCTION, tmp_path / "mine")
    return tmp_path / "mine" / "junction.sumocfg"


@pytest.fixture
def deadly(junction: Path) -> Path:
    """A network in which a connection leads over another junction: SUMO ends with SIGSEGV."""
    net = junction.with_name("junction.net.xml")
    text = net.read_text()
    broken = text.replace('via=":zebra_0_0"', 'via=":centre_17_0"')
    assert broken != text
    net.write_text(broken)
    return junction


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty one."""
    monkeypatch.setattr(first_reading, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(first_reading, "_known", set())
    return tmp_path / "cache"


def test_a_network_that_kills_sumo_is_one_line_in_process_too(deadly) -> None:
    program = (
        "import giveway, sys\n"
        "try:\n    giveway.run({'scenario': sys.argv[1], 'time_limit': 1.0})\n"
        "except giveway.GivewayError as error:\n    print('said:', error)\n"
    )
    ended = subprocess.run(
        [sys.executable, "-c", program, str(deadly)],
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    (line,) = ended.stdout.splitlines()
    assert line.startswith(f"said: {deadly}: SUMO crashes while reading this scenario (SIGSEGV)")


def command_of(config: Path) -> list[str]:
    return ["sumo", "-c", str(config), "--no-step-log", "true"]


def test_a_scenario_is_read_first_once_for_each_content(junction, cache) -> None:
    net = junction.with_name("junction.net.xml")

    def read(patience: float) -> None:
        read_first(junction, command_of(junction), [net], patience=patience)

    with pytest.raises(SumoError, match=r"still reading this scenario after 0\.001 s; look"):
        read(0.001)
    read(60.0)
    read(0.001)
    first_reading._known.clear()
    read(0.001)  # another process knows it from the cache
    net.write_text(net.read_text() + "<!-- edited -->\n")
    with pytest.raises(SumoError, match="still reading"):
        read(0.001)


def test_a_process_that_is_watched_over_reads_at_once(deadly, cache, monkeypatch) -> None:
    monkeypatch.setattr(child, "_supervised", True)
    read_first(deadly, command_of(deadly), [deadly])
    assert not cache.exists()


def test_what_sumo_refuses_in_words_is_left_to_the_run(junction, cache) -> None:
    junction.with_name("junction.net.xml").write_text("<net")
    read_first(junction, command_of(junction), [junction])
