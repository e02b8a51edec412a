"""The copies of scenario files that write outputs, which go into the results folder."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from giveway.errors import ScenarioError
from giveway.scenario_files.configuration import located
from giveway.scenario_files.included import READS
from giveway.scenario_files.markup import rewrite
from giveway.scenario_files.outputs import OutputFolder, is_file
from giveway.scenario_files.reading import opened, pieces

_WRITES: Final = {
    **dict.fromkeys(
        (
            *("e1Detector", "inductionLoop", "instantInductionLoop"),
            *("e2Detector", "laneAreaDetector", "e3Detector", "entryExitDetector"),
            *("edgeData", "laneData", "routeProbe", "vTypeProbe"),
        ),
        "file",
    ),
    "timedEvent": "dest",
    "calibrator": "output",
}
"""Attribute that names a file which SUMO writes, by element."""

_PICTURES: Final = ("imgFile", "osgFile")
_DEVICES: Final = ("device.ssm.file", "device.toc.file")  # parameters of a type or a vehicle
_SSM: Final = "has.ssm.device"
_ELEMENTS: Final = frozenset({*_WRITES, *READS, "param", "poly", "poi", "vType"})

# A file that writes or refers to another file contains one of these texts. They are searched for
# before the file is parsed.
# first, which is far faster than parsing the file.
_SIGNS: Final = tuple(
    sign.encode()
    for sign in (
        *("etector", "nductionLoop", "edgeData", "laneData", "routeProbe", "vTypeProbe"),
        *("timedEvent", "calibrator", "variableSpeedSign", "rerouter", "<include"),
        *(*_DEVICES, _SSM),
        *('"file"', "'file'"),
    )
)


class Copies:
    """Prepares scenario files so that a run writes nothing beside them.

    A file that names no output is used where it is. A file that names one is copied, with its
    outputs placed in the results folder and the names of other files made absolute.

    Args:
        config_file: Path of the .sumocfg, to which the names in vehicles' parameters are relative.
        scratch: Folder for the copies, which are needed while the simulation runs.
        outputs: Folder of the outputs.

    Attributes:
        config_file: Path as given.
        has_ssm: True if a type or vehicle in the prepared files has an SSM device.
    """

    def __init__(self, config_file: Path, scratch: Path, outputs: OutputFolder) -> None:
        self.config_file = config_file
        self._scratch = scratch
        self._outputs = outputs
        self._prepared: dict[Path, Path] = {}
        self.has_ssm = False
        # included files that do not exist, with the files that include them
        self.missing: dict[Path, Path] = {}

    @property
    def read(self) -> tuple[Path, ...]:
        """The files that were prepared, and all files that they include."""
        return tuple(self._prepared)

    @property
    def made(self) -> dict[Path, Path]:
        """The original of each copy, for messages that name the copy."""
        return {copy: file for file, copy in self._prepared.items() if copy != file}

    def prepared(self, file: Path) -> Path:
        """Return the file for SUMO in place of ``file``: itself, or its copy.

        Raises:
            ScenarioError: the file, or one that it includes, cannot be read.
        """
        if file in self._prepared:
            return self._prepared[file]
        self._prepared[file] = file  # SUMO refuses a file that includes itself
        try:
            if _has_signs(file):
                self._prepared[file] = self._copied(file)
        except (OSError, EOFError) as error:
            raise ScenarioError(
                f"{file}: cannot be read ({error}); the scenario needs it; put it there"
            ) from error
        return self._prepared[file]

    def _copied(self, file: Path) -> Path:
        self._scratch.mkdir(parents=True, exist_ok=True)
        name = file.name.removesuffix(".gz")
        copy = self._scratch / f"{len(self._prepared)}-{name}"
        editor = _Editor(file, self)
        with opened(file) as source, copy.open("wb") as target:
            rewrite(source, target, editor.changes, _ELEMENTS)
        if editor.needed:
            return copy
        copy.unlink()
        return file

    def redirected(self, name: str, named_in: Path) -> str:
        """Return the path in the results folder of the output ``name`` in ``named_in``."""
        return str(self._outputs.place(located(name, named_in)))


class _Editor:
    """Finds the changes in the copy of one file."""

    def __init__(self, file: Path, copies: Copies) -> None:
        self._file = file
        self._copies = copies
        self.needed = False  # True if an output was found, here or in an included file

    def changes(self, name: str, attributes: Mapping[str, str], parent: str) -> dict[str, str]:
        changes = {}
        for attribute in _PICTURES:
            if attributes.get(attribute):
                changes[attribute] = str(located(attributes[attribute], self._file))
        written = attributes.get(_WRITES.get(name, ""), "")
        if is_file(written):
            changes[_WRITES[name]] = self._redirected(written, self._file)
        referred = attributes.get(READS.get(name, ""), "")
        if referred:
            there = located(referred, self._file)
            if not there.is_file():
                self._copies.missing[there] = self._file
            copy = self._copies.prepared(there) if there.is_file() else there
            self.needed |= copy != there
            changes[READS[name]] = str(copy)
        if name == "param":
            changes |= self._parameter(
                attributes.get("key", ""), attributes.get("value", ""), parent
            )
        return changes

    def _parameter(self, key: str, value: str, parent: str) -> dict[str, str]:
        self._copies.has_ssm |= key == _SSM
        if key in _DEVICES and is_file(value):
            return {"value": self._redirected(value, self._copies.config_file)}
        # the detectors of an actuated traffic light
        if key == "file" and parent == "tlLogic" and is_file(value):
            return {"value": self._redirected(value, self._file)}
        return {}

    def _redirected(self, name: str, named_in: Path) -> str:
        self.needed = True
        return self._copies.redirected(name, named_in)


def _has_signs(file: Path) -> bool:
    """Return whether the file can name an output at all; it is read once, in pieces."""
    return any(sign in text for text in pieces(file) for sign in _SIGNS)
