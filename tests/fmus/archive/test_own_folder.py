"""A temporary folder of a process: locked while it is in use, swept by the next process if not."""

import gc
import itertools
import subprocess
import sys
from pathlib import Path

import pytest

from fmus.archive import own_folder
from fmus.archive.own_folder import OwnFolder

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks")

HOLDS = """
import sys, time
from pathlib import Path
from fmus.archive.own_folder import OwnFolder
folder = OwnFolder("kind-", Path(sys.argv[1]))
(Path(folder.name) / "file").touch()
print(folder.name, flush=True)
time.sleep(60)
"""


@pytest.fixture
def holder(tmp_path, monkeypatch):
    monkeypatch.setattr(own_folder, "_swept", set())
    with subprocess.Popen(
        [sys.executable, "-c", HOLDS, str(tmp_path)], stdout=subprocess.PIPE, text=True
    ) as process:
        process.folder = Path(process.stdout.readline().strip())
        yield process
        process.kill()


def test_that_of_a_killed_process_goes_and_that_of_a_living_one_stays(holder, tmp_path):
    with OwnFolder("kind-", tmp_path) as name:
        assert Path(name).is_dir()
        assert (holder.folder / "file").is_file()
    own_folder._swept.clear()
    holder.kill()
    holder.wait()
    with OwnFolder("kind-", tmp_path) as name:
        assert [str(path) for path in tmp_path.iterdir()] == [name]
    assert list(tmp_path.iterdir()) == []


def test_a_link_and_folders_of_another_kind_are_left_alone(tmp_path, monkeypatch):
    monkeypatch.setattr(own_folder, "_swept", set())
    precious = tmp_path / "precious"
    precious.mkdir()
    (tmp_path / "kind-link").symlink_to(precious)
    with OwnFolder("kind-", tmp_path):
        pass
    assert precious.is_dir()
    assert (tmp_path / "kind-link").is_symlink()


def test_a_signal_in_the_removal_leaves_nothing_and_goes_on(tmp_path, monkeypatch):
    folder = OwnFolder("kind-", tmp_path)
    removals = []
    remove = own_folder.shutil.rmtree

    def interrupted(name, **options):
        removals.append(name)
        if len(removals) == 1:
            raise KeyboardInterrupt
        remove(name, **options)

    monkeypatch.setattr(own_folder.shutil, "rmtree", interrupted)
    with pytest.raises(KeyboardInterrupt):
        folder.cleanup()
    assert list(tmp_path.iterdir()) == []


def _interrupted_at(number, work):
    """Do ``work`` with a signal before the line of that number; return whether it came so far."""
    left = itertools.count(-number)

    def trace(frame, event, _argument):
        if frame.f_code.co_filename != own_folder.__file__:
            return None
        if event == "line" and next(left) == 0:
            raise KeyboardInterrupt
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        work()
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(before)
    return False


def test_a_signal_between_any_two_lines_leaves_nothing(tmp_path):
    def work():
        with OwnFolder("kind-", tmp_path) as name:
            (Path(name) / "file").touch()

    work()
    for number in itertools.count():
        reached = _interrupted_at(number, work)
        gc.collect()
        assert list(tmp_path.iterdir()) == [], number
        if not reached:
            break
    assert number > 20


def test_an_error_right_after_it_was_made_leaves_nothing(tmp_path):
    program = HOLDS.replace("time.sleep(60)", "raise KeyboardInterrupt")
    subprocess.run([sys.executable, "-c", program, str(tmp_path)], capture_output=True, check=False)
    assert list(tmp_path.iterdir()) == []
