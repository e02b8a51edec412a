"""SUMO options as a user types them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from giveway.errors import ConfigError
from giveway.scenario_files.options import canonical

if TYPE_CHECKING:
    from collections.abc import Sequence

_OURS: Final = ("configuration-file", "remote-port", "num-clients")  # not the user's to set


def parse_options(extra: Sequence[str]) -> dict[str, str]:
    """The user's own SUMO options, by the name that SUMO's help lists.

    Raises:
        ConfigError: a word is no option, or an option is not the user's to set.
    """
    options: dict[str, str] = {}
    words = list(extra)
    while words:
        word = words.pop(0)
        if not word.startswith("-") or word.strip("-") == "":
            msg = f"SUMO option '{word}': expected a name that begins with --, like --scale 0.5"
            raise ConfigError(msg)
        name, equals, value = word.lstrip("-").partition("=")
        if not equals:
            value = words.pop(0) if words and not _is_option(words[0]) else "true"
        name = canonical(name)
        if name in _OURS:
            msg = f"SUMO option '{word}': giveway sets it itself; leave it out"
            raise ConfigError(msg)
        if name == "seed" and not value.lstrip("-").isdecimal():
            msg = f"SUMO option --seed '{value}': expected a whole number"
            raise ConfigError(msg)
        options[name] = value
    return options


def _is_option(word: str) -> bool:
    return word.startswith("-") and len(word) > 1 and not word[1].isdigit() and word[1] != "."
