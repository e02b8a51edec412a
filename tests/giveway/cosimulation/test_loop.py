"""The master loop: one control step after the other."""

from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest

import giveway
from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.cosimulation.assembly import Parts, assemble
from giveway.cosimulation.loop import Loop
from giveway.cosimulation.preflight import preflight
from giveway.errors import GivewayError
from giveway.journal.recorder import Recorder
from giveway.processes.interrupts import DeferredInterrupt
from giveway.run_data.progress import Ending


def parts_of(stack: ExitStack, **settings: object) -> Parts:
    return assemble(preflight(*load([Layer("test", settings)])), stack)


def test_a_nan_in_the_crowd_is_named_by_id_and_step() -> None:
    with ExitStack() as stack:
        parts = parts_of(stack, controller="pid")
        recorder = Recorder()
        loop = Loop(parts, recorder)
        parts.roster.crowd.position[3] = np.nan
        with pytest.raises(GivewayError, match=r"ped3.*step 0"):
            loop.run(None, DeferredInterrupt())
        assert len(recorder.rows().time) == 1


def test_after_a_failure_the_next_run_is_unharmed(tmp_path: Path) -> None:
    test_a_nan_in_the_crowd_is_named_by_id_and_step()
    assert giveway.run({"crowd": {"pedestrians": 3}}).ending is Ending.COMPLETED
