"""The exit codes of the command line, and its errors, which are one line each."""

import contextlib
import sys

_LONGEST = 300  # Largest number of characters of a word that are shown


def fail(message: str, code: int) -> int:
    """Print one line on stderr, and return the exit code.

    The message may quote a user's file, or SUMO that quotes it. Invisible characters could control
    the terminal, and a word of a thousand letters could hide the rest of the line.
    """
    line = visible(" ".join(map(_shortened, message.split())))
    with contextlib.suppress(OSError):  # the terminal may have been closed
        sys.stderr.write(f"error: {line}\n")
    return code


def visible(text: str) -> str:
    """Return ``text`` with question marks for control characters other than line breaks."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in text)


def _shortened(word: str) -> str:
    """Return a word, without its middle if it is long."""
    left_out = len(word) - _LONGEST
    half = _LONGEST // 2
    if left_out <= 0:
        return word
    return f"{word[:half]}...({left_out} more characters)...{word[-half:]}"
