"""The pool of one machine: how it takes runs, and how it ends."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import textwrap
from dataclasses import replace
from pathlib import Path

import psutil
import pytest

from giveway.config import RunConfig
from giveway.studies.execution import WorkerError, local_executor
from giveway.studies.identity import input_hashes, software_identity
from sumo_scenarios import find

SCRIPT = """
import sys
from pathlib import Path
from giveway.studies.execution import local_executor
from giveway.studies.record import Task

config, code = Path(sys.argv[1]).read_text(), sys.argv[2]
tasks = [Task(str(n), str(n), config, {{}}, code) for n in range(100000)]
{body}
"""


@pytest.fixture(scope="module")
def one_worker():
    """An executor with one worker, which stays."""
    with local_executor(jobs=1) as executor:
        yield executor


@pytest.fixture
def script(tmp_path, task):
    """Starts a Python of its own that has 100,000 tasks."""
    started = []

    def start(body: str) -> subprocess.Popen[str]:
        program, config = tmp_path / "study.py", tmp_path / "config.json"
        program.write_text(SCRIPT.format(body=textwrap.dedent(body)))
        config.write_text(task("x").config)
        process = subprocess.Popen(
            [sys.executable, str(program), str(config), software_identity()],
            env=os.environ | {"TMPDIR": str(tmp_path)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


def test_every_run_is_made_once_and_like_in_one_process(
    healthy, expected, numbers, left_behind, tmp_path, monkeypatch
):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with local_executor(jobs=2) as executor:
        assert executor.workers == 2
        made = {record.run: numbers(record) for record in executor.run(healthy)}
        assert made == expected
        assert len(list(tmp_path.iterdir())) == 1
    assert list(tmp_path.iterdir()) == []


def test_tasks_are_taken_when_they_are_needed_and_workers_stay(one_worker, task, worker_of):
    taken = 0

    def plan():
        nonlocal taken
        for number in range(12):
            taken += 1
            yield task(f"r{number}", number)

    first = one_worker.run(plan())
    one = next(first)
    assert taken <= 3
    assert len({record.computing.worker for record in (one, *first)}) == 1
    (again,) = one_worker.run([task("again")])
    assert again.computing.worker == one.computing.worker
    if sys.platform == "linux":  # short of memory, the system takes a worker first
        score = Path(f"/proc/{worker_of(again).pid}/oom_score_adj").read_text().strip()
        assert score == "500"
    assert list(one_worker.run([])) == []


def test_a_study_that_is_given_up_leaves_no_process(task, left_behind):
    with local_executor(jobs=1) as executor:
        for _ in executor.run(task(f"r{n}", n) for n in range(1000)):
            break
        assert left_behind() == []
        (again,) = executor.run([task("again")])
        assert not again.failed


def test_a_run_whose_worker_was_killed_is_made_again(
    healthy, expected, numbers, worker_of, left_behind
):
    with local_executor(jobs=1) as executor:
        made = []
        for record in executor.run(healthy):
            made.append(record)
            if len(made) == 2:
                worker_of(record).kill()
    assert {record.run: numbers(record) for record in made} == expected


def test_ctrl_c_ends_all_at_once(script):
    study = script(
        """
        with local_executor(jobs=2) as executor:
            for record in executor.run(tasks):
                assert not record.failed, record.failure
                print(record.run, flush=True)
        """
    )
    assert study.stdout.readline()
    workers = psutil.Process(study.pid).children(recursive=True)
    assert len(workers) == 2
    study.send_signal(signal.SIGINT)
    _, errors = study.communicate(timeout=120)
    assert errors.strip().endswith("KeyboardInterrupt")
    assert errors.count("Traceback") == 1
    assert psutil.wait_procs(workers, timeout=60)[1] == []


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a thread sees to it, in time")
def test_workers_die_with_the_study(script, tmp_path):
    study = script(
        """
        with local_executor(jobs=1) as executor:
            for record in executor.run(tasks):
                print(record.run, flush=True)
        """
    )
    assert study.stdout.readline()
    workers = psutil.Process(study.pid).children(recursive=True)
    assert len(workers) == 1
    study.kill()
    assert psutil.wait_procs(workers, timeout=60)[1] == []


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory")
def test_workers_that_cannot_start_are_an_error_that_says_why(script):
    study = script(
        """
        import resource
        from giveway.studies.execution import WorkerError
        with local_executor(jobs=1) as executor:
            # enough for the threads of this process, too little for what a worker imports
            resource.setrlimit(resource.RLIMIT_AS, (450_000_000, resource.RLIM_INFINITY))
            try:
                list(executor.run(tasks))
            except WorkerError as error:
                print(error)
        """
    )
    output, errors = study.communicate(timeout=180)
    assert errors == ""
    (line,) = output.splitlines()
    assert "5 processes in turn have ended before they could make a run (" in line
    assert "--jobs" in line


def test_a_file_that_changes_while_the_study_is_at_work_ends_it(
    tmp_path, task, refused, left_behind
):
    """Else the record would stand under the hash of a file that the run has not read."""
    more = tmp_path / "more.add.xml"
    more.write_text("<additional/>\n", encoding="utf-8")
    options = ["--additional-files", str(more)]
    config = task("x", sumo={"options": options}).config
    settings = RunConfig.model_validate_json(config)
    tasks = [
        replace(
            task(f"c1-s{n}", n, sumo={"options": options}),
            inputs=input_hashes(settings, find(settings.scenario)),
        )
        for n in range(1, 9)
    ]
    assert any("more.add.xml" in name for name in tasks[0].inputs)
    made = []
    with (
        refused(WorkerError, "more.add.xml", "another content", "--resume"),
        local_executor(jobs=1) as executor,
    ):
        for record in executor.run(tasks):
            assert not record.failed, record.failure
            made.append(record)
            more.write_text("<additional><!-- other --></additional>\n", encoding="utf-8")
    assert 1 <= len(made) < 4


def test_a_scenario_missing_on_the_worker_is_no_runs_failure(tmp_path, task, refused, one_worker):
    there = tmp_path / "theirs"
    shutil.copytree(find("shared_space").config_file.parent, there)
    planned = task("a", scenario=str(there))
    settings = RunConfig.model_validate_json(planned.config)
    planned = replace(planned, inputs=input_hashes(settings, find(settings.scenario)))
    shutil.rmtree(there)
    with refused(WorkerError, "shared_space.", "found nothing", "the same path on every machine"):
        list(one_worker.run([planned]))


def test_other_software_than_the_plans_makes_no_run(task, refused, one_worker):
    stranger = replace(task("a"), software="another")
    with refused(WorkerError, "differ from those that planned run a", "same versions", "--resume"):
        list(one_worker.run([stranger]))
