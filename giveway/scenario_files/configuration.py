"""The contents of a .sumocfg: input files, outputs, and the settings that a run depends on."""

import os
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Final, TypeVar
from urllib.parse import unquote

from giveway.errors import ScenarioError
from giveway.scenario_files.options import (
    INPUTS,
    INSTEAD_OF_SIMULATING,
    LISTS,
    OUTPUTS,
    canonical,
)
from giveway.scenario_files.reading import is_bomb

_Value = TypeVar("_Value")

SUMO_SEED: Final = 23423  # Seed of SUMO if neither scenario nor command line names one
# Default pedestrian model of SUMO, the only one whose persons can be moved
STRIPING: Final = "striping"

_LATEST: Final = 9e15  # Largest time [s]: SUMO counts milliseconds in 63 bits
_A_TIME: Final = "seconds, h:m:s or d:h:m:s"
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_TRUE = frozenset({"true", "1", "yes", "on", "x", "t"})
_FALSE = frozenset({"false", "0", "no", "off", "-", "f"})


@dataclass(frozen=True)
class ScenarioFiles:
    """The contents of a .sumocfg; all paths are absolute.

    Attributes:
        config_file: Path of the .sumocfg.
        options: Value of each option that it sets, by the name in SUMO's help.
        net_file: Path of the road network.
        route_files, additional_files: Paths in the order in which SUMO reads them.
        begin: First instant [s].
        end: Last instant [s]; None if the scenario ends when nobody is left.
        step_length: Step of SUMO [s].
        seed: Seed that the scenario names, or None for SUMO's own.
        random: True if SUMO is to seed itself with the clock.
        pedestrian_model: Pedestrian model of SUMO, ``striping`` if none is named.
        outputs: File or files of each output option that is set, as the scenario names them.
    """

    config_file: Path
    options: Mapping[str, str]
    net_file: Path
    route_files: tuple[Path, ...]
    additional_files: tuple[Path, ...]
    begin: float
    end: float | None
    step_length: float
    seed: int | None
    random: bool
    pedestrian_model: str
    outputs: Mapping[str, tuple[str, ...]]

    @cached_property
    def inputs(self) -> tuple[tuple[str, Path], ...]:
        """The files that SUMO reads because an option names them: (option, file)."""
        return tuple(
            (option, path)
            for option in INPUTS
            for path in _paths(self.config_file, self.options.get(option, ""))
        )

    @property
    def missing(self) -> tuple[tuple[str, Path], ...]:
        """The files of :attr:`inputs` that do not exist."""
        return tuple(
            (option, path)
            for option, path in self.inputs
            if not os.path.exists(path)  # noqa: PTH110 - Path's own raises if a name is too long
        )

    @property
    def teleport_settings(self) -> dict[str, str]:
        """The scenario's own options for teleporting."""
        return {name: value for name, value in self.options.items() if "teleport" in name}

    def is_set(self, option: str) -> bool:
        """Return whether the scenario switches a yes-or-no option on."""
        return self.options.get(option, "").strip().lower() in _TRUE

    def require_inputs(self) -> None:
        """Make sure that SUMO's input files exist.

        Raises:
            ScenarioError: a file does not exist; the message names the first one.
        """
        for option, path in self.missing:
            raise ScenarioError(
                f"{self.config_file}: {option} names {path}, which does not exist; expected a file "
                "(relative paths start at the .sumocfg's folder); put it there or correct the name"
            )
        for option, path in self.inputs:
            if "," in str(path):
                raise ScenarioError(
                    f"{self.config_file}: {option} names {path}; SUMO takes the ',' for the end of "
                    "a file's name; expected a path without one; rename the folder"
                )
            if path.is_dir():
                raise ScenarioError(
                    f"{self.config_file}: {option} names the folder {path}; expected a file"
                )
            if not os.access(path, os.R_OK):
                raise ScenarioError(
                    f"{self.config_file}: {option} names {path}, which you may not read; "
                    "expected a readable file; change its permissions"
                )
            if is_bomb(path):
                raise ScenarioError(
                    f"{self.config_file}: {option} names {path}, which unpacks to more than a "
                    "hundred times its size; expected a file of a scenario; look at its content"
                )


def read_scenario(config_file: Path) -> ScenarioFiles:
    """Read ``config_file``; :attr:`ScenarioFiles.missing` lists the files that do not exist.

    Options may be in sections or not, under any of SUMO's names, with the value in ``value``, ``v``
    or as text. Lists are separated by commas; ``${NAME}`` stands for an environment variable.

    Raises:
        ScenarioError: the file is missing, empty or not XML, or it names no network, an option
            twice, or a value of the wrong kind.
    """
    config_file = Path(os.path.abspath(config_file))  # resolve() would follow links  # noqa: PTH100
    options = _options(config_file)
    for name in INSTEAD_OF_SIMULATING:
        if name in options:
            raise ScenarioError(
                f"{config_file}: {name} = '{options[name]}' makes SUMO write that file instead of "
                "simulating; expected a configuration to simulate; remove the option"
            )
    networks = _paths(config_file, options.get("net-file", ""))
    if len(networks) != 1:
        value = options.get("net-file", "")
        raise ScenarioError(
            f"{config_file}: net-file = '{value}'; expected one road network; "
            'add <net-file value="NETWORK.net.xml"/>'
        )
    time = partial(_parsed, config_file, options, parse=seconds, expected=_A_TIME)
    step_length, end = time("step-length"), time("end")
    step_length = 1.0 if step_length is None else step_length
    if step_length <= 0.0:
        raise ScenarioError(
            f"{config_file}: step-length = {step_length:g}; expected more than 0 s, like 0.1"
        )
    return ScenarioFiles(
        config_file=config_file,
        options=options,
        net_file=networks[0],
        route_files=_paths(config_file, options.get("route-files", "")),
        additional_files=_paths(config_file, options.get("additional-files", "")),
        begin=time("begin") or 0.0,
        end=None if end is None or end < 0.0 else end,
        step_length=step_length,
        seed=_parsed(config_file, options, "seed", int, "a whole number"),
        random=bool(_parsed(config_file, options, "random", _truth, "true or false")),
        pedestrian_model=options.get("pedestrian.model", STRIPING).strip(),
        outputs={name: _names(options[name], name) for name in OUTPUTS if name in options},
    )


def _options(config_file: Path) -> dict[str, str]:
    options: dict[str, str] = {}
    for element in list(_root(config_file).iter())[1:]:
        value = element.get("value", element.get("v", element.text or ""))
        name = canonical(element.tag)
        if not value.strip():
            continue  # a section, or an option that is not changed
        if name in options:
            raise ScenarioError(
                f"{config_file}: {name} = '{value}' stands there a second time "
                f"(first '{options[name]}'); expected once; remove one"
            )
        options[name] = _VARIABLE.sub(lambda found: os.environ.get(found[1], ""), value)
    return options


def _root(config_file: Path) -> ET.Element:
    expected = "expected a SUMO configuration (.sumocfg)"
    try:
        content = config_file.read_bytes()  # SUMO does not read a compressed one, either
    except FileNotFoundError:
        raise ScenarioError(f"{config_file}: no such file; {expected}") from None
    except OSError as error:
        raise ScenarioError(f"{config_file}: cannot be read ({error}); {expected}") from None
    if not content.strip():
        raise ScenarioError(f"{config_file}: the file is empty; {expected}")
    try:
        return ET.fromstring(content)
    except (ET.ParseError, ValueError, LookupError) as error:
        raise ScenarioError(f"{config_file}: not XML ({error}); {expected}") from None


def _names(value: str, option: str) -> tuple[str, ...]:
    """Return the files that an option names, as they are written."""
    parts = value.split(",") if option in LISTS or option not in OUTPUTS else [value]
    return tuple(part.strip() for part in parts if part.strip())


def _paths(config_file: Path, value: str) -> tuple[Path, ...]:
    """Return the files in a list; %20 and the like are decoded as SUMO does in a .sumocfg."""
    return tuple(located(unquote(name), config_file) for name in _names(value, ""))


def located(name: str, named_in: Path) -> Path:
    """Return the path that ``name`` means in the file ``named_in``."""
    path = Path(name).expanduser() if name.startswith("~/") else Path(name)
    return Path(os.path.abspath(named_in.parent / path))  # noqa: PTH100 - resolve() follows links


def seconds(text: str) -> float:
    """Convert a time of SUMO to seconds: seconds, ``h:m:s`` or ``d:h:m:s``.

    Raises:
        ValueError: the text is none of these, or the time is beyond SUMO's clock.
    """
    parts = [float(part) for part in text.split(":")]
    if len(parts) not in (1, 3, 4):
        raise ValueError(text)
    days, hours, minutes, rest = [0.0] * (4 - len(parts)) + parts
    time = ((days * 24.0 + hours) * 60.0 + minutes) * 60.0 + rest
    if not abs(time) <= _LATEST:  # also false for nan
        raise ValueError(text)
    return time


def _truth(text: str) -> bool:
    """Return whether ``text`` is a word for true; anything but true or false is an error."""
    if text.lower() not in _TRUE | _FALSE:
        raise ValueError(text)
    return text.lower() in _TRUE


def _parsed(
    config_file: Path,
    options: Mapping[str, str],
    name: str,
    parse: Callable[[str], _Value],
    expected: str,
) -> _Value | None:
    """Return the value of an option, or None if it is not set."""
    if name not in options:
        return None
    try:
        return parse(options[name].strip())
    except ValueError:
        raise ScenarioError(
            f"{config_file}: {name} = '{options[name]}'; expected {expected}"
        ) from None
