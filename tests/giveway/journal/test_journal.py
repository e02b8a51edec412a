"""The journal: what has been committed is read back, to the bit, whatever the file's end."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.lib.recfunctions import structured_to_unstructured

from giveway.errors import ResultsError
from giveway.gate import MAKER
from giveway.journal.journal import ROWS_FILE, Journal, JournalRows, NameTable
from giveway.journal.journal_reader import read_journal
from giveway.processes.heartbeat import Heartbeat, Phase

NAMES = st.text(st.characters(), max_size=8)  # lone surrogates, quotes, newlines and all


def three_steps(folder: Path) -> Journal:
    """Ego rows 0, 1, 2 with one new vehicle each, a crowd of k persons in step k."""
    journal = Journal(folder)
    ego, crowd = journal.rows("ego", ("step", "id")), journal.rows("crowd", ("x", "y", "z"))
    vehicles = journal.names("vehicles")
    for k in range(3):
        ego.block(1)[0] = k, vehicles.index(f"veh{k}")
        crowd.block(k)[:] = k
        journal.commit()
    return journal


def test_committed_rows_are_read_while_the_writer_lives(tmp_path: Path) -> None:
    journal = three_steps(tmp_path)
    contents = read_journal(tmp_path)
    assert contents.commits == 3
    assert contents.tables["ego"].tolist() == [(0, 0), (1, 1), (2, 2)]
    assert contents.tables["crowd"].tolist() == [(1, 1, 1), (2, 2, 2), (2, 2, 2)]
    assert contents.names == {"vehicles": ("veh0", "veh1", "veh2")}
    journal.close()


def test_rows_of_a_step_that_was_not_committed_are_not_there(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    rows = journal.rows("ego", ("step",))
    rows.block(1)[0] = 1.0
    journal.commit()
    rows.block(1)[0] = 2.0
    assert read_journal(tmp_path).tables["ego"].tolist() == [(1.0,)]
    journal.close()
    assert read_journal(tmp_path).tables["ego"].tolist() == [(1.0,), (2.0,)]


@settings(max_examples=40)
@given(
    steps=st.lists(
        st.tuples(st.integers(0, 700), st.lists(NAMES, max_size=4), st.booleans()), max_size=12
    ),
    columns=st.integers(1, 7),
)
def test_what_goes_in_comes_out(
    tmp_path_factory: pytest.TempPathFactory,
    steps: list[tuple[int, list[str], bool]],
    columns: int,
) -> None:
    folder = tmp_path_factory.mktemp("journal")
    journal = Journal(folder)
    called = [f"column {k}" for k in range(columns)]
    rows, names = journal.rows("rows", called), journal.names("names")
    random = np.random.default_rng(columns)
    expected = np.empty((0, columns))
    for count, new, commit in steps:
        values = random.normal(size=(count, columns))
        rows.block(count)[:] = values
        expected = np.concatenate([expected, values])
        indices = [names.index(name) for name in new]
        assert [names.names[index] for index in indices] == new
        if commit:
            journal.commit()
    journal.close()
    contents = read_journal(folder)
    assert np.array_equal(structured_to_unstructured(contents.tables["rows"]), expected)
    assert np.array_equal(structured_to_unstructured(rows.filled), expected)
    distinct = dict.fromkeys(name for _, new, _ in steps for name in new)
    assert contents.names["names"] == names.names == tuple(distinct)


def test_nan_and_infinity_survive(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    journal.rows("rows", ("a", "b", "c")).block(1)[0] = np.nan, np.inf, -0.0
    journal.close()
    assert repr(read_journal(tmp_path).tables["rows"].tolist()) == "[(nan, inf, -0.0)]"


def used(file: Path) -> bytes:
    """Up to and with the last commit record: its kind is the last byte that is not zero."""
    content = file.read_bytes()
    return content[: len(content.rstrip(b"\0")) + 15]


@pytest.mark.parametrize("rest", [b"", bytes(1000)], ids=["cut off", "not filled"])
def test_torn_anywhere_it_gives_whole_steps(tmp_path: Path, rest: bytes) -> None:
    three_steps(tmp_path).close()
    file = tmp_path / ROWS_FILE
    whole = used(file)
    seen = set()
    for length in range(len(whole) + 1):
        file.write_bytes(whole[:length] + rest)
        contents = read_journal(tmp_path)
        seen.add(contents.commits)
        if contents.commits:
            assert contents.tables["ego"]["step"].tolist() == list(range(contents.commits))
            assert len(contents.tables["crowd"]) == sum(range(contents.commits))
            assert len(contents.names["vehicles"]) == contents.commits
        else:
            assert contents.tables == {}
    assert seen == {0, 1, 2, 3}


@pytest.mark.parametrize(
    "rubbish", [b"\xff" * 100, bytes(100), b"\x03\0\0\0\0\0\0\0" + b"\x7f" * 8]
)
def test_rubbish_at_its_end_is_left_out(tmp_path: Path, rubbish: bytes) -> None:
    three_steps(tmp_path).close()
    file = tmp_path / ROWS_FILE
    file.write_bytes(used(file) + rubbish)
    assert read_journal(tmp_path).commits == 3


def test_somebody_elses_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / ROWS_FILE).write_text("id,x,y\n1,2,3\n")
    with pytest.raises(ResultsError, match="is not a journal of giveway"):
        read_journal(tmp_path)


def test_another_versions_journal_is_refused(tmp_path: Path) -> None:
    three_steps(tmp_path).close()
    file = tmp_path / ROWS_FILE
    file.write_bytes(b"giveway1" + file.read_bytes()[8:])
    with pytest.raises(ResultsError, match="another version's"):
        read_journal(tmp_path)


def test_a_run_that_died_while_loading_left_only_its_pulse(tmp_path: Path) -> None:
    Heartbeat(tmp_path).beat(Phase.LOADING)
    contents = read_journal(tmp_path)
    assert (contents.tables, contents.names, contents.meta) == ({}, {}, {})
    assert contents.pulse.phase is Phase.LOADING


def test_meta_is_kept_and_replaced_whole(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    journal.write_meta({"config": "seed = 1\n", "pedestrians": ["a", "ö\n"]})
    journal.write_meta({"config": "seed = 2\n"})
    meta = read_journal(tmp_path).meta
    assert {key: meta[key] for key in meta if key != MAKER} == {"config": "seed = 2\n"}
    journal.close()


def test_without_a_folder_rows_are_just_rows(tmp_path: Path) -> None:
    journal = Journal(None)
    rows = journal.rows("rows", ("a", "b"))
    rows.block(2)[:] = 7.0
    journal.write_meta({})
    journal.commit()
    journal.heartbeat.beat(Phase.SUMO)
    journal.close()
    assert rows.filled.tolist() == [(7.0, 7.0), (7.0, 7.0)]
    assert not journal.failure


def test_filled_rows_stay_while_the_table_grows() -> None:
    rows = JournalRows(("up", "down"))
    for k in range(5000):
        rows.block(1)[0] = k, -k
    rows.block(100_000)[:] = 0.5
    assert rows.filled["up"][:5000].tolist() == list(range(5000))
    assert (rows.filled["down"][5000:] == 0.5).all()
    assert len(rows.filled) == 105_000


def test_a_name_has_one_index() -> None:
    names = NameTable()
    assert [names.index(name) for name in ("b", "a", "b", "", "a")] == [0, 1, 0, 2, 1]
    assert names.names == ("b", "a", "")


def test_a_folder_that_is_gone_costs_the_journal_and_not_the_run(tmp_path: Path) -> None:
    journal = Journal(tmp_path / "gone")
    rows = journal.rows("rows", ("a",))
    rows.block(1)[0] = 1.0
    journal.commit()
    journal.heartbeat.step(1, 0.05)
    assert "cannot be written (No such file or directory)" in journal.failure
    assert len(rows.filled) == 1


FULL_DISK = """
import resource, sys
from pathlib import Path
from giveway.journal.journal import Journal

resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))  # as if the disk were full
journal = Journal(Path(sys.argv[1]))
rows = journal.rows("rows", "abcdefghij")
for k in range(1000):
    rows.block(1)[0] = k
    journal.commit()
assert rows.filled["a"].tolist() == list(range(1000))  # nothing is lost
print(journal.failure)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_a_full_disk_is_told_and_the_run_goes_on(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", FULL_DISK, str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=180,
        check=True,
    )
    assert "the journal cannot be written (File too large); the run goes on" in done.stdout
    rows = read_journal(tmp_path).tables["rows"]  # 112 bytes a step; the last is torn
    assert rows["a"].tolist() == list(range(len(rows)))
    assert 170 < len(rows) < 179


def test_a_heartbeat_is_read_by_another_mapping(tmp_path: Path) -> None:
    child = Heartbeat.supervised_by(4711, tmp_path)
    child.step(246, 12.3)
    child.beat(Phase.SUMO)
    pulse = Heartbeat(tmp_path).read()
    assert pulse == (Phase.SUMO, 246, 12.3, 0, 4711)
    assert pulse.place == "inside SUMO's step from 12.30 s (step 246)"
    child.finish(3)
    assert Heartbeat(tmp_path).read().code == 3


def test_a_heartbeat_that_was_overwritten_is_still_read(tmp_path: Path) -> None:
    heartbeat = Heartbeat(tmp_path)
    heartbeat.beat(-123456789)
    assert heartbeat.read().phase is Phase.LOADING
