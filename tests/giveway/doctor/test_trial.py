"""The doctor's trial of SUMO: no answer and a crash are findings."""

from __future__ import annotations

import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from giveway.doctor.trial import judged, try_in_sumo

if TYPE_CHECKING:
    from pathlib import Path


def test_a_sumo_that_does_not_answer_is_given_up(small_city: Path) -> None:
    (finding,) = try_in_sumo(small_city, patience=0.01)
    assert finding.level == "error"
    assert "still busy after 0.01 s" in finding.text


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="other systems have no signals")
def test_a_sumo_that_crashes_is_a_finding(small_city: Path) -> None:
    crash = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"
    result = subprocess.run(
        [sys.executable, "-c", crash], check=False, capture_output=True, text=True
    )
    (finding,) = judged(small_city, result)
    assert finding.text == "SUMO crashed (SIGSEGV)"
