"""A Dask cluster: the same records, whatever becomes of its workers."""

from __future__ import annotations

import os
import re
from dataclasses import replace

import psutil
import pytest

from giveway.studies.execution import WorkerError, cluster_executor
from giveway.studies.execution.cluster import ClusterExecutor
from giveway.studies.execution.limits import Limits

distributed = pytest.importorskip("distributed")


@pytest.fixture
def empty_cluster():
    """A scheduler without workers."""
    with distributed.LocalCluster(n_workers=0, dashboard_address=None) as cluster:
        yield cluster


def dask_workers() -> list[psutil.Process]:
    """The Dask workers of a local cluster: processes of ours that have a giveway worker."""
    mine = psutil.Process().children()
    return [process for process in mine if process.children()]


def test_records_stay_though_workers_die_and_freeze(
    task, healthy, expected, numbers, faulty, left_behind
):
    others = [task(f"r{n}", n) for n in range(100, 116)]
    made, told = [], []
    with ClusterExecutor("local:2", Limits(hang=4.0), told.append) as executor:
        assert executor.workers == 2
        for record in executor.run([*healthy, faulty("segfault"), *others]):
            made.append(record)
            if len(made) == 1:
                dead, frozen = dask_workers()
                dead.kill()
            elif len(made) == 12:
                frozen.suspend()
    assert len(made) == len(healthy) + 1 + len(others)
    records = {record.run: record for record in made}
    assert {run: numbers(records[run]) for run in expected} == expected
    crash = records.pop("segfault")
    assert crash.ending == "crashed"
    assert re.match(r"SIGSEGV in the vehicle FMU's step from 4\.\d\d s", crash.failure)
    assert crash.computing.attempts == 2
    assert not any(record.failed for record in records.values())
    assert len({record.computing.worker for record in made}) > 2
    assert [line for line in told if "has stood still for 4 s; its runs go to others" in line]


def test_workers_that_come_late_are_waited_for(left_behind, empty_cluster, task, worker_of):
    told = []

    def tell(line: str) -> None:
        told.append(line)
        empty_cluster.scale(1)

    address = empty_cluster.scheduler_address
    with ClusterExecutor(address, Limits(), tell, patience=60.0) as executor:
        (record,) = executor.run([task("a")])
        assert not record.failed
        assert empty_cluster.workers  # somebody else's cluster goes on
        worker = worker_of(record)
        assert worker in psutil.Process().children(recursive=True)
    assert told == [f"cluster {address}: it has no worker; waiting 60 s for it, nothing is lost"]
    assert psutil.wait_procs([worker], timeout=60.0)[1] == []


def test_nobody_comes(empty_cluster, task, refused):
    address = empty_cluster.scheduler_address
    told = []
    with (
        ClusterExecutor(address, Limits(), told.append, patience=1.0) as executor,
        refused(WorkerError, address, "it has no worker", "for 1 s", "--resume"),
    ):
        list(executor.run([task("a")]))
    assert len(told) == 1


def test_a_scheduler_that_ends_is_an_error_and_results_stay(task, refused):
    made = []
    cluster = distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=50
    )
    address = cluster.scheduler_address
    with (
        ClusterExecutor(address, Limits(), lambda _: None, patience=2.0) as executor,
        refused(WorkerError, address, "does not answer", "--resume"),
    ):
        for record in executor.run(task(f"r{n}", n) for n in range(10_000)):
            made.append(record)
            if len(made) == 3:
                cluster.close()
    assert len({record.run for record in made}) == len(made) >= 3


def test_another_giveway_is_refused_by_name(empty_cluster, task, refused):
    empty_cluster.scale(1)
    stranger = replace(task("a"), software="another")
    with (
        cluster_executor(empty_cluster.scheduler_address) as executor,
        refused(WorkerError, "worker", "tcp://127.0.0.1", os.uname().nodename, "same versions"),
    ):
        list(executor.run([stranger]))
