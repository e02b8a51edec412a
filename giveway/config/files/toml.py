"""The reading of users' TOML files; every problem is reported in one line."""

import tomllib
from pathlib import Path
from typing import Any

from giveway.errors import ConfigError
from giveway.gate import DEEPEST, is_deep


def read_toml_file(file: Path, expected: str, called: str | None = None) -> dict[str, Any]:
    """Return the content of a TOML file.

    Args:
        file: File to be read.
        expected: Kind of file that it should be, for messages: "a preset file".
        called: Name of the file in messages, or None for its path.

    Raises:
        ConfigError: the file is not there, cannot be read, or is not TOML.
    """
    origin = str(file) if called is None else called
    try:
        text = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise ConfigError(f"{origin}: no such file; expected {expected} (TOML)") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        msg = f"{origin}: cannot be read ({reason}); expected {expected} (TOML)"
        raise ConfigError(msg) from error
    return parse_toml(text, origin)


def parse_toml(text: str, origin: str) -> dict[str, Any]:
    """Return the content of a TOML text.

    Args:
        text: Text of a file.
        origin: Name of the text in messages.

    Raises:
        ConfigError: the text is not TOML.
    """
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{origin}: not valid TOML: {error}; correct this line") from None
    except ValueError:  # Python's: it reads no longer ones
        raise ConfigError(
            f"{origin}: a number of thousands of digits; expected one of a few; shorten it"
        ) from None
    except RecursionError:
        values = None
    if values is None or is_deep(values):
        raise ConfigError(
            f"{origin}: lists or tables in one another, more than {DEEPEST} deep; expected a few "
            "levels; look for a row of brackets"
        )
    return values


def toml_value(text: str) -> Any:
    """A value as TOML has it; what is no TOML is a word."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text
