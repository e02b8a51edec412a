"""The check before a run."""

from contextlib import ExitStack

import pytest

from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.cosimulation.assembly import Parts, assemble
from giveway.cosimulation.preflight import preflight
from giveway.errors import ConfigError, DatasetError


def parts_of(stack: ExitStack, **settings: object) -> Parts:
    return assemble(preflight(*load([Layer("test", settings)])), stack)


def test_time_steps_that_do_not_fit_sumos_are_refused() -> None:
    with ExitStack() as stack, pytest.raises(ConfigError, match="whole multiple"):
        parts_of(stack, time_step=0.03)


def test_a_recording_is_read_before_sumo_is_loaded() -> None:
    entry = {"name": "yard", "path": "nowhere", "dataset": "dut"}
    config = load([Layer("test", {"crowd": {"recorded": [entry]}})])
    with pytest.raises(DatasetError, match=r"'yard': path = '.*nowhere': no such file or folder"):
        preflight(*config)
