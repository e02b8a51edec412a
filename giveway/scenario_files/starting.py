"""The start of SUMO with a user's scenario: the settings that are kept or replaced."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final
from urllib.parse import unquote

from giveway.scenario_files.configuration import STRIPING, SUMO_SEED, ScenarioFiles, located
from giveway.scenario_files.copies import Copies
from giveway.scenario_files.options import OUTPUTS, parse_options
from giveway.scenario_files.outputs import OutputFolder, is_file

_VALIDATION: Final = ("xml-validation", "xml-validation.net", "xml-validation.routes")
_WINDOW_ONLY: Final = ("osg-view",)  # options that only a SUMO with OpenSceneGraph knows
_SAVING_STATES: Final = ("save-state.times", "save-state.period")


WRITTEN: Final[Mapping[str, str]] = MappingProxyType(
    {
        "fcd": "fcd-output",
        "tripinfo": "tripinfo-output",
        "summary": "summary-output",
        "ssm": "device.ssm.file",
    }
)
"""The option of SUMO for each output that a user can ask for by name."""


@dataclass(frozen=True)
class StartOptions:
    """The settings for SUMO beyond the scenario's own.

    Attributes:
        seed: Seed of SUMO, or None to keep the scenario's or SUMO's own.
        fallback_seed: Seed for a scenario that asks for a random one, if neither ``seed`` nor the
            scenario names one.
        step_length: Step of SUMO [s], or None to keep the scenario's.
        interact: True if persons or vehicles are to be moved. Otherwise SUMO simulates the scenario
            exactly as without giveway.
        outputs: Folder for SUMO's output files, or None to drop them.
        written: Keys of ``WRITTEN``: outputs that are written even if the scenario does not.
        extra: Further options as on SUMO's command line, which override giveway's.
    """

    seed: int | None = None
    fallback_seed: int = SUMO_SEED
    step_length: float | None = None
    interact: bool = True
    outputs: Path | None = None
    written: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()


@dataclass(frozen=True)
class Start:
    """A command that starts SUMO, with its files and remarks.

    Attributes:
        command: Command for ``libsumo.start``.
        remarks: Differences from the scenario, one line each, for the user.
        outputs: File that is written instead of each output file of the scenario.
        copies: Original of each rewritten copy of a scenario file.
        read: Network, routes and additional files of the scenario, with all that they include.
        seed: Seed in effect.
    """

    command: tuple[str, ...]
    remarks: tuple[str, ...]
    outputs: Mapping[Path, Path]
    copies: Mapping[Path, Path]
    read: tuple[Path, ...]
    seed: int

    def with_original_names(self, message: str) -> str:
        """Return SUMO's ``message`` with the scenario's file names instead of the copies'."""
        for copy, original in self.copies.items():
            message = message.replace(str(copy), str(original))
        return message


def prepare_start(
    scenario: ScenarioFiles,
    options: StartOptions,
    scratch: Path,
    *,
    types: str = "<additional/>",
) -> Start:
    """Prepare a start of SUMO that runs ``scenario`` without touching its folder.

    Args:
        scenario: Files of the scenario.
        options: Settings for SUMO.
        scratch: Folder of the caller's own, which is kept until SUMO is closed.
        types: Text of an additional file that is read before the scenario's own: the types of all
            that is going to be added.

    Raises:
        ScenarioError: an input file is missing or cannot be read.
        ResultsError: the output folder cannot be used.
        ConfigError: ``options.extra`` holds an option that cannot be passed on.
    """
    scenario.require_inputs()
    scratch.mkdir(parents=True, exist_ok=True)
    return _Preparation(scenario, options, scratch).start(types)


class _Preparation:
    """Collects the options of SUMO's command, and the remarks on them for the user."""

    def __init__(self, scenario: ScenarioFiles, options: StartOptions, scratch: Path) -> None:
        self._scenario = scenario
        self._wanted = options
        self._scratch = scratch
        self._outputs = OutputFolder(options.outputs or scratch / "outputs")
        self._copies = Copies(scenario.config_file, scratch / "copies", self._outputs)
        self._options: dict[str, str] = {}
        self._remarks: list[str] = []

    def start(self, types: str) -> Start:
        """Return the command that starts SUMO, with the files, remarks and seed that belong to it.

        Args:
            types: Text of the additional file that is read first.
        """
        extra = parse_options(self._wanted.extra)
        self._inputs(types, extra.pop("additional-files", ""))
        extra |= {name: self._placed_extra(extra[name]) for name in OUTPUTS if name in extra}
        self._randomness()
        self._time()
        if self._wanted.interact:
            self._interaction()
        self._own_outputs()
        self._wanted_outputs()
        self._say_where()
        self._connections()
        self._options |= {"gui-settings-file": "", "verbose": "false"}
        self._options |= {"no-step-log": "true", "duration-log.disable": "true"}
        self._options |= extra
        own_seed = self._scenario.seed
        command = ["sumo", "-c", str(self._config_file())]
        for name, value in self._options.items():
            command += [f"--{name}", value]
        return Start(
            tuple(command),
            tuple(self._remarks),
            dict(self._outputs.placed),
            self._copies.made,
            self._copies.read,
            int(self._options.get("seed", SUMO_SEED if own_seed is None else own_seed)),
        )

    def _config_file(self) -> Path:
        """Return the .sumocfg, or a copy without options that only some builds of SUMO know."""
        own = self._scenario.options
        unknown = [name for name in _WINDOW_ONLY if name in own]
        if not unknown:
            return self._scenario.config_file
        placed: dict[str, list[str]] = {}
        for name, path in self._scenario.inputs:
            placed.setdefault(name, []).append(str(path))
        kept = {name: value for name, value in own.items() if name not in unknown}
        root = ET.Element("configuration")
        for name, value in kept.items():
            ET.SubElement(root, name, value=",".join(placed.get(name, [value])))
        copy = self._scratch / self._scenario.config_file.name
        ET.ElementTree(root).write(copy, encoding="utf-8", xml_declaration=True)
        self._remarks.append(f"{', '.join(unknown)}: left out; there is no window")
        return copy

    def _inputs(self, types: str, more: str) -> None:
        """Set the input files: giveway's types first, then copies of files that write."""
        own = self._scratch / "giveway.add.xml"
        own.write_text(types, encoding="utf-8")
        # Naming additional files on the command line replaces the scenario's list.
        paths = [own, *map(self._copies.prepared, self._scenario.additional_files)]
        paths += [Path(name.strip()) for name in more.split(",") if name.strip()]
        self._options["additional-files"] = ",".join(map(str, paths))
        for name, files in (
            ("net-file", (self._scenario.net_file,)),
            ("route-files", self._scenario.route_files),
        ):
            copies = [self._copies.prepared(file) for file in files]
            if copies != list(files):
                self._options[name] = ",".join(map(str, copies))
        self._remarks += [
            f"{file}: names {missing.name}, which is not in {missing.parent}; SUMO goes on without"
            for missing, file in self._copies.missing.items()
        ]

    def _randomness(self) -> None:
        seed = self._wanted.seed
        if self._scenario.random:
            own = self._scenario.seed
            fallback = self._wanted.fallback_seed if own is None else own
            seed = fallback if seed is None else seed
            self._options["random"] = "false"
            self._remarks.append(
                f"random: the scenario asks for a seed by the clock; seed {seed} is used instead, "
                "so that the run can be repeated"
            )
        if seed is not None:
            self._options["seed"] = str(seed)

    def _time(self) -> None:
        step = self._wanted.step_length
        if step is None:
            return
        self._options["step-length"] = f"{step:.6f}"
        if abs(step - self._scenario.step_length) > 1e-9:
            self._remarks.append(
                f"step-length: {step:g} s instead of the scenario's "
                f"{self._scenario.step_length:g} s; SUMO's own traffic differs with the step"
            )

    def _interaction(self) -> None:
        """Set the options that SUMO needs if persons and vehicles are moved."""
        model = self._scenario.pedestrian_model
        self._options["pedestrian.model"] = STRIPING
        if model != STRIPING:
            self._remarks.append(
                f"pedestrian.model: striping instead of the scenario's {model}; only persons of "
                "this model can be moved"
            )
        own = self._scenario.options
        self._options["collision.action"] = "warn"
        if own.get("collision.action", "warn") != "warn":
            self._remarks.append(
                f"collision.action: warn instead of the scenario's {own['collision.action']}; "
                "a vehicle that is moved must not be taken off the road"
            )
        if "collision.check-junctions" not in own:
            self._options["collision.check-junctions"] = "true"

    def _connections(self) -> None:
        """Prevent waiting for other programs or servers; outputs to an address stay unchanged."""
        own = self._scenario.options
        for name in _VALIDATION:
            if own.get(name) in ("auto", "always"):
                # the schemas that come with SUMO, not those of the web
                self._options[name] = "local"
        for option, names in self._scenario.outputs.items():
            self._remarks += [
                f"{option}: {name} is a network address, left as it is; somebody must listen there"
                for name in names
                if not is_file(name) and ":" in name
            ]
        if own.get("remote-port", "0") != "0":
            self._options["remote-port"] = "0"
            self._remarks.append(
                f"remote-port: not opened; the scenario's {own['remote-port']} would wait for a "
                "TraCI client for ever"
            )

    def _own_outputs(self) -> None:
        """Place every output that the scenario's options name, and those that SUMO names itself."""
        own = self._scenario.options
        for name, files in self._scenario.outputs.items():
            if any(map(is_file, files)):  # streams stay as the scenario has them
                self._options[name] = ",".join(map(self._placed, files))
        if any(name in own for name in _SAVING_STATES) and "save-state.prefix" not in own:
            self._options["save-state.prefix"] = self._placed("state")  # beside the .sumocfg
        has_ssm = self._copies.has_ssm or any(name.startswith("device.ssm.") for name in own)
        if has_ssm and "device.ssm.file" not in own:
            # SUMO's own default is one file per vehicle in the working folder.
            self._options["device.ssm.file"] = self._placed("ssm.xml")
        for name in ("output-prefix", "output-suffix"):
            self._without_folder(name)

    def _placed(self, name: str) -> str:
        if not is_file(name):
            return name
        return str(self._outputs.place(located(unquote(name), self._scenario.config_file)))

    def _without_folder(self, name: str) -> None:
        """Cut the folder off a prefix, which would lead out of the results folder."""
        value = self._scenario.options.get(name, "")
        last = value.replace("\\", "/").rsplit("/", 1)[-1]
        if last != value:
            self._options[name] = last
            self._remarks.append(
                f"{name}: '{last}' instead of the scenario's '{value}'; SUMO's outputs stay in "
                "one folder"
            )

    def _wanted_outputs(self) -> None:
        """Add the outputs that the user wants and the scenario does not have."""
        wanted = self._wanted.written
        for name in wanted:
            if WRITTEN[name] not in self._options:
                self._options[WRITTEN[name]] = self._placed(f"{name}.xml")
        own = self._scenario.options
        if "ssm" in wanted and not any(name.startswith("device.ssm.") for name in own):
            self._options["device.ssm.probability"] = "1"

    def _placed_extra(self, value: str) -> str:
        """Return the place of a user's own output; a relative name goes into the output folder."""
        return self._placed(value) if is_file(value) and not Path(value).is_absolute() else value

    def _say_where(self) -> None:
        files = sorted(path.name for path in self._outputs.placed.values())
        if not files:
            return
        shown = ", ".join(files[:5]) + (f" and {len(files) - 5} more" if len(files) > 5 else "")
        if self._wanted.outputs is None:
            self._remarks.append(
                f"outputs: {shown} are dropped; name a results folder to keep them"
            )
        else:
            self._remarks.append(f"outputs: in {self._outputs.folder}: {shown}")
