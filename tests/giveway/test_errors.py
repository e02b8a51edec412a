"""The words of giveway's errors."""

import errno
import os
from pathlib import Path
from typing import Annotated

import pytest
from pydantic import BaseModel, Field, ValidationError

import giveway
from giveway.errors import (
    InstallationError,
    ResultsError,
    VehicleError,
    as_request,
    in_words,
    remedy,
)
from giveway.results.folder import write_results


class Options(BaseModel):
    number: Annotated[int, Field(ge=0, le=50_000)] = 1
    share: Annotated[float, Field(gt=0.0, le=0.5)] = 0.5
    on: bool = True
    name: str = ""


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"number": "ten"}, "should be a whole number"),
        ({"number": 1.5}, "should be a whole number"),
        ({"number": -1}, "should be at least 0"),
        ({"number": 50_001}, "should be at most 50000"),
        ({"share": "half"}, "should be a number"),
        ({"share": 0.6}, "should be at most 0.5"),
        ({"share": 0.0}, "should be greater than 0"),
        ({"on": "perhaps"}, "should be true or false"),
        ({"name": 3}, "should be a text"),
    ],
)
def test_a_refused_value_is_explained_in_plain_words(values: dict, words: str) -> None:
    with pytest.raises(ValidationError) as refusal:
        Options(**values)
    assert in_words(refusal.value.errors()[0]) == words


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (errno.ENOSPC, "free the disk"),
        (errno.ENOENT, "the folder has gone"),
        (errno.EROFS, "in which you may write"),
        (errno.ENAMETOOLONG, "shorter names"),
        (errno.EIO, "another disk"),
    ],
)
def test_only_a_full_disk_is_to_be_freed(number: int, expected: str) -> None:
    told = remedy(OSError(number, os.strerror(number)))
    assert expected in told
    assert ("free" in told) == (number == errno.ENOSPC)


def test_a_run_whose_folder_is_removed_says_so(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    result = giveway.run({"scenario": "encounter", "time_limit": 1.0})
    folder.rmdir()
    with pytest.raises(ResultsError, match="the folder has gone"):
        write_results(result, folder)


@pytest.mark.parametrize(("kind", "code"), [(VehicleError, 2), (InstallationError, 1)])
def test_before_a_run_an_error_is_one_of_the_request(
    kind: type[giveway.GivewayError], code: int
) -> None:
    with pytest.raises(kind) as refused, as_request():
        raise kind("no such file")
    assert refused.value.exit_code == code
    assert kind("in a step").exit_code == 1
