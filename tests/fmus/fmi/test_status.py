"""The statuses of FMI in words."""

import pytest

from fmus.fmi.status import DISCARD, ENDED, FATAL, WARNING, named


@pytest.mark.parametrize(
    ("status", "words"),
    [
        (0, "'OK'"),
        (WARNING, "'warning'"),
        (DISCARD, "'discard'"),
        (FATAL, "'fatal'"),
        (ENDED, "'end of the simulation'"),
        (7, "status 7"),
        (-1, "status -1"),
    ],
)
def test_a_status_has_a_name_unless_fmi_knows_none(status: int, words: str) -> None:
    assert named(status) == words
