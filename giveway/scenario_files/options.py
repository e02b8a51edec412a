"""The options of SUMO that name files, and others whose complete list giveway needs.

The tables hold for SUMO 1.28. A test compares them with the output of ``sumo --save-template``, so
that no output option of a later version is missed. libsumo does not contain that program.
"""

from collections.abc import Sequence
from typing import Final

from giveway.errors import ConfigError

OUTPUTS: Final = (
    "amitran-output",
    "battery-output",
    "bt-output",
    "chargingstations-output",
    "collision-output",
    "deadlock-output",
    "device.rerouting.output",
    "device.ssm.file",
    "device.taxi.dispatch-algorithm.output",
    "device.taxi.idle-algorithm.output",
    "device.toc.file",
    "edgedata-output",
    "elechybrid-output",
    "emission-output",
    "error-log",
    "fcd-output",
    "full-output",
    "lanechange-output",
    "lanedata-output",
    "link-output",
    "log",
    "message-log",
    "netstate-dump",
    "overheadwiresegments-output",
    "pedestrian.jupedsim.py",
    "pedestrian.jupedsim.wkt",
    "person-fcd-output",
    "person-summary-output",
    "personinfo-output",
    "personroute-output",
    "queue-output",
    "railsignal-block-output",
    "railsignal-vehicle-output",
    "save-state.files",
    "save-state.prefix",
    "statistic-output",
    "stop-output",
    "substations-output",
    "summary-output",
    "tripinfo-output",
    "vehroute-output",
    "vtk-output",
)
"""All options whose value is a file that SUMO writes while it simulates."""

LISTS: Final = frozenset({"save-state.files"})
"""Outputs whose value is a list of files."""

INSTEAD_OF_SIMULATING: Final = ("save-configuration", "save-schema", "save-template")
"""Options with which SUMO writes a file and does not simulate."""

INPUTS: Final = (
    "net-file",
    "route-files",
    "additional-files",
    "weight-files",
    "load-state",
    "fcd-output.filter-edges.input-file",
    "device.ssm.filter-edges.input-file",
    "astar.all-distances",
    "astar.landmark-distances",
    "device.fcd-replay.files",
)
"""All options whose value is one or several files that SUMO reads without a window."""

_OURS: Final = ("configuration-file", "remote-port", "num-clients")
"""Options that only giveway sets."""

_NAMES: Final = {
    "net-file": "n net",
    "route-files": "r routes",
    "additional-files": "a additional",
    "weight-files": "w weights",
    "device.fcd-replay.files": "device.fcd-replay.file",
    "configuration-file": "c configuration",
    "save-configuration": "C save-config",
    "netstate-dump": "ndump netstate netstate-output",
    "person-fcd-output": "person-fcd",
    "summary-output": "summary",
    "tripinfo-output": "tripinfo",
    "personinfo-output": "personinfo",
    "vehroute-output": "vehroutes",
    "personroute-output": "personroutes",
    "statistic-output": "statistics-output",
    "log": "l log-file",
    "begin": "b",
    "end": "e",
    "random": "abs-rand",
    "seed": "srand",
    "verbose": "v",
    "gui-settings-file": "g",
    "edgedata-files": "data-files m",
    "alternative-net-file": "N",
    "duration-log.disable": "no-duration-log",
}
SYNONYMS: Final = {
    synonym: name for name, synonyms in _NAMES.items() for synonym in synonyms.split()
}
"""Name in SUMO's help of each other name of an option that giveway reads or sets."""


def canonical(name: str) -> str:
    """Return the name of the option in SUMO's help."""
    return SYNONYMS.get(name, name)


def parse_options(extra: Sequence[str]) -> dict[str, str]:
    """Return the user's own SUMO options, by their names in SUMO's help.

    Raises:
        ConfigError: a word is no option, or the user may not set the option.
    """
    options: dict[str, str] = {}
    words = list(extra)
    while words:
        word = words.pop(0)
        if not word.startswith("-") or word.strip("-") == "":
            raise ConfigError(
                f"SUMO option '{word}': expected a name that begins with --, like --scale 0.5"
            )
        name, equals, value = word.lstrip("-").partition("=")
        if not equals:
            value = words.pop(0) if words and not _is_option(words[0]) else "true"
        name = canonical(name)
        if name in _OURS:
            raise ConfigError(f"SUMO option '{word}': giveway sets it itself; leave it out")
        if name == "seed" and not value.lstrip("-").isdecimal():
            raise ConfigError(f"SUMO option --seed '{value}': expected a whole number")
        options[name] = value
    return options


def _is_option(word: str) -> bool:
    return word.startswith("-") and len(word) > 1 and not word[1].isdigit() and word[1] != "."
