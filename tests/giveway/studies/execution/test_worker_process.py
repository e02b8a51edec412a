"""What becomes of runs that take their process along, beside others that do not."""

from __future__ import annotations

import os
import re
import sys
from collections import Counter

import pytest

from giveway.studies.execution import local_executor

# what an FMU does: how the run's record tells it
FATES = {
    "segfault": r"SIGSEGV in the vehicle FMU's step from 4\.\d\d s \(step \d\d\)",
    "exit_0": r"exit\(0\) called by native code in the vehicle FMU's step from 4\.\d\d s \(.*\)",
    "sleep_forever": (
        r"no progress for [34](\.\d+)? s in the vehicle FMU's step from 4\.\d\d s \(.*\)"
    ),
}


@pytest.fixture(scope="module")
def records(healthy, faulty):
    """Of one go, the faulty runs in between the healthy ones."""
    tasks = [faulty(fault, time_limit=60.0) for fault in (*FATES, "error")]
    for place, task in enumerate(healthy):
        tasks.insert(2 * place, task)
    with local_executor(jobs=2, hang_limit=3.0) as executor:
        made = list(executor.run(tasks))
    assert Counter(record.run for record in made) == Counter(task.run for task in tasks)
    return {record.run: record for record in made}


@pytest.mark.parametrize("fault", FATES)
def test_a_crash_is_a_record_that_tells_cause_and_place(records, fault):
    record = records[fault]
    assert record.ending == "crashed"
    assert re.fullmatch(FATES[fault], record.failure), record.failure
    assert record.failure.isprintable()
    assert record.rows == ()
    assert record.computing.attempts == 2


def test_a_run_that_goes_on_for_too_long_is_ended(faulty):
    with local_executor(jobs=1, run_limit=0.5) as executor:
        (record,) = executor.run([faulty("slow", time_limit=60.0)])
    assert record.failure.startswith("not finished within 0.5 s, the limit of a run, ")
    assert record.computing.attempts == 2


def test_a_refusal_is_not_an_accident_and_not_tried_again(records):
    record = records["error"]
    assert record.ending == "failed"
    assert "the axle broke" in record.failure
    assert record.computing.attempts == 1


def test_the_others_do_not_notice(records, healthy, expected, numbers):
    for task in healthy:
        assert numbers(records[task.run]) == expected[task.run]
        assert records[task.run].computing.attempts == 1


def test_a_worker_that_has_grown_is_replaced(faulty, task):
    with local_executor(jobs=1) as executor:
        made = list(executor.run([task("a"), faulty("memory"), task("b"), task("c")]))
    small, grown, fresh, last = (record.computing for record in made)
    assert grown.memory > small.memory + 256.0
    assert grown.worker == small.worker
    assert fresh.worker == last.worker != grown.worker


@pytest.mark.skipif(sys.platform == "win32", reason="there are no named pipes to wait at")
def test_what_sumo_said_last_is_told(task, tmp_path):
    """SUMO waits for ever to read a pipe, after a word about an option."""
    pipe = tmp_path / "nobody.add.xml"
    os.mkfifo(pipe)
    options = ["--ignore-accidents", "true", "--additional-files", str(pipe)]
    with local_executor(jobs=1, run_limit=2.0) as executor:
        silent, spoken = executor.run([task("a"), task("b", sumo={"options": options})])
    assert not silent.failed
    assert re.match(r"not finished within .* while the run was being set up", spoken.failure)
    assert "after printing 'Warning: The option 'ignore-accidents' is dep" in spoken.failure
