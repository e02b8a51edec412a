"""The check of a plug-in in a process of its own, which only the command itself may end."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")


def _has_begun_a_battery(process):
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return any(b"spawn_main" in Path(f"/proc/{c}/cmdline").read_bytes() for c in children)


EARLY = """
import os, signal, sys
from multiprocessing import popen_spawn_posix
from giveway.cli import main

launch = popen_spawn_posix.util.spawnv_passfds

def signalled(*words):
    child = launch(*words)
    if any(b"spawn_main" in os.fsencode(word) for word in words[1]):
        os.kill(os.getpid(), signal.SIGTERM)
    return child

popen_spawn_posix.util.spawnv_passfds = signalled
sys.argv = ["giveway", "check", "controller", "idm"]
main()
"""


def test_a_signal_while_the_battery_gets_its_task_gives_one_line():
    done = subprocess.run(
        [sys.executable, "-c", EARLY], capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr) == (143, "error: ended by SIGTERM\n")


@pytest.mark.parametrize("later", [0.0, 0.05, 0.3])
def test_control_c_from_the_terminal_gives_one_line(later):
    words = [sys.executable, "-m", "giveway", "check", "controller", "idm"]
    with subprocess.Popen(
        words, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        while not _has_begun_a_battery(process):
            assert process.poll() is None
            time.sleep(0.002)
        time.sleep(later)
        os.killpg(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == "error: interrupted\n"


def test_for_a_script(type_here):
    told = json.loads(type_here("check", "controller", "idm", "--json").stdout)
    assert {"rule": "can be made", "problem": ""} in told["rules"]
    assert told["broken"] == sum(bool(rule["problem"]) for rule in told["rules"])
    assert told["controller"] == "idm"
