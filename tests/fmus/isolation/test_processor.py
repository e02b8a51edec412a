"""A vehicle and its FMU's process take turns on one processor, unless the FMU has threads."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from fmus.isolation.processor import UNKNOWN, Follower, current

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has these calls")

ALONE = """
import os
from fmus.isolation.processor import Follower
follower, usual = Follower(), os.sched_getaffinity(0)
for step in range(19):
    follower.follow(max(usual))
assert os.sched_getaffinity(0) == usual, "an FMU may still be starting its threads"
for processor in (max(usual), max(usual), min(usual)):
    follower.follow(processor)
    assert os.sched_getaffinity(0) == {processor}
follower.follow(-1)
assert os.sched_getaffinity(0) == {min(usual)}, "the vehicle does not say where it is"
"""


def test_a_process_of_one_thread_follows():
    subprocess.run([sys.executable, "-c", ALONE], check=True)


def test_a_process_with_threads_keeps_all_processors():
    usual, end = os.sched_getaffinity(0), threading.Event()
    other = threading.Thread(target=end.wait)
    other.start()
    try:
        follower = Follower()
        for _ in range(50):
            follower.follow(min(usual))
        threads = [int(entry.name) for entry in Path("/proc/self/task").iterdir()]
        assert len(threads) > 1
        assert all(os.sched_getaffinity(thread) == usual for thread in threads)
    finally:
        end.set()
        other.join()


def test_the_fmu_is_beside_its_vehicle_which_may_go_anywhere(isolated):
    usual = os.sched_getaffinity(0)
    vehicle = isolated()
    vehicle.start()
    for _ in range(40):
        vehicle.step(100.0)
    watchdog = vehicle._process._host._watchdog.process.pid
    (worker,) = Path(f"/proc/{watchdog}/task/{watchdog}/children").read_text().split()
    assert len(os.sched_getaffinity(int(worker))) == 1
    assert os.sched_getaffinity(0) == usual
    assert current() in usual
    assert current() != UNKNOWN
