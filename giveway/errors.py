"""The errors of giveway, one class per problem that a user can solve.

Every message is one line: the file, key or id, the value, what was expected, and what to do next.
``exit_code`` is the command line's: 2 for a request that cannot be run, 1 for a run that failed.
"""

import difflib
import errno
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any, Final


class GivewayError(Exception):
    """The root of all errors that giveway raises on purpose.

    Attributes:
        result: Result :class:`giveway.RunResult` recorded until the failure, or None before the
            start.
    """

    exit_code = 1
    result: Any = None  # not typed: errors import nothing


class InstallationError(GivewayError):
    """The installation lacks something or is wrong; the message says how to repair it."""


class ConfigError(GivewayError):
    """A configuration key, flag or value cannot be used."""

    exit_code = 2


class ScenarioError(GivewayError):
    """A scenario cannot be found, or does not fit the request."""

    exit_code = 2


class SumoError(GivewayError):
    """SUMO refused a request. The message has SUMO's own reason."""


class VehicleError(GivewayError):
    """The vehicle FMU cannot be loaded or failed in a step."""


class ControlError(GivewayError):
    """The controller cannot be set up as configured, or its command cannot be used."""


class RuleError(GivewayError):
    """A rule of another package cannot be made, or its demand cannot be used."""


class MetricError(GivewayError):
    """A metric of another package has columns or values that cannot be used."""


class SensorError(GivewayError):
    """A sensor cannot be made, or its answer cannot be used."""


class CrowdError(GivewayError):
    """The pedestrians cannot be placed or moved as configured."""


class CrashError(GivewayError):
    """Native code (SUMO, an FMU, a solver) ended or hung the run's process; the rows are kept."""


class DatasetError(GivewayError):
    """Recorded trajectories cannot be read, or there are too few for the request."""

    exit_code = 2


class ResultsError(GivewayError):
    """The results cannot be written, or would replace existing files."""

    exit_code = 2


@contextmanager
def as_request() -> Iterator[None]:
    """Give the errors in this context the exit code of a request that cannot be run.

    Before a run begins, a missing FMU is a user's mistake as a wrong key is. What the installation
    lacks is not.
    """
    try:
        yield
    except InstallationError:
        raise
    except GivewayError as error:
        error.exit_code = ConfigError.exit_code
        raise


_REMEDIES: Final = (
    ("free the disk", ("ENOSPC", "EDQUOT", "EFBIG")),
    ("the folder has gone: make it again, or name another one", ("ENOENT", "ENOTDIR", "ESTALE")),
    ("name a folder in which you may write", ("EACCES", "EPERM", "EROFS")),
    ("choose shorter names", ("ENAMETOOLONG",)),
    ("raise the limit of open files (ulimit -n)", ("EMFILE", "ENFILE")),
)
"""The remedies for a file that cannot be written, by the names of the system's errors."""


def remedy(error: OSError) -> str:
    """Return what the user can do about a file that cannot be written, in words."""
    name = errno.errorcode.get(error.errno or 0, "")
    named = (words for words, names in _REMEDIES if name in names)
    return next(named, "name a folder on another disk")


@contextmanager
def retold(theirs: type[Exception], ours: type[Exception]) -> Iterator[None]:
    """Tell an error of another package as one of giveway's in this context, in the same words.

    Args:
        theirs: Class of the other package's error.
        ours: Class of the error that is raised instead.
    """
    try:
        yield
    except theirs as error:
        raise ours(str(error)) from error


def suggestion(name: str, known: Collection[str], otherwise: str = "", cutoff: float = 0.5) -> str:
    """Return the known name that is meant in words, or what is expected if none is close.

    Args:
        name: Unknown name.
        known: Known names.
        otherwise: Words if no name is close; empty if they are to list the known names.
        cutoff: Least similarity, from 0 to 1.
    """
    close = difflib.get_close_matches(name, known, n=1, cutoff=cutoff)
    expected = otherwise or f"expected one of {', '.join(known)}"
    return f"did you mean '{close[0]}'?" if close else expected


_WORDS: Final = {
    "int_type": "should be a whole number",
    "int_parsing": "should be a whole number",
    "int_from_float": "should be a whole number",
    "float_type": "should be a number",
    "float_parsing": "should be a number",
    "bool_type": "should be true or false",
    "bool_parsing": "should be true or false",
    "string_type": "should be a text",
    "greater_than_equal": "should be at least {ge:.12g}",
    "less_than_equal": "should be at most {le:.12g}",
}
"""Plain words for pydantic's types of errors."""


def in_words(error: Any) -> str:
    """Return what a refused value should be, in plain words.

    Args:
        error: One error of a pydantic ``ValidationError``.
    """
    words = _WORDS.get(error["type"])
    if words is None:
        return str(error["msg"]).removeprefix("Input ")
    bounds = {k: v for k, v in error.get("ctx", {}).items() if isinstance(v, int | float)}
    return words.format(**bounds)
