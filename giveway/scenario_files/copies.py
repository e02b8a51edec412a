"""Copies of scenario files that write outputs: these go into the results folder."""

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
"""Element to the attribute that names a file which SUMO writes."""

_PICTURES: Final = ("imgFile", "osgFile")
_DEVICES: Final = ("device.ssm.file", "device.toc.file")  # parameters of a type or a vehicle
_SSM: Final = "has.ssm.device"
_ELEMENTS: Final = frozenset({*_WRITES, *READS, "param", "poly", "poi", "vType"})

# A file that writes or refers to another file contains one of these signs. They are searched for
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
        config_file: The .sumocfg, to which the names in vehicles' parameters are relative.
        scratch: Folder for the copies; they are needed as long as the simulation runs.
        outputs: Folder of the outputs.

    Attributes:
        config_file: File as given.
        has_ssm: True if a type or vehicle in the prepared files carries an SSM device.
    """

    def __init__(self, config_file: Path, scratch: Path, outputs: OutputFolder) -> None:
        self.config_file = config_file
        self._scratch = scratch
        self._outputs = outputs
        self._prepared: dict[Path, Path] = {}
        self.has_ssm = False
        self.missing: dict[Path, Path] = {}  # included but absent files, to the including one

    @property
    def read(self) -> tuple[Path, ...]:
        """Files that were prepared, and all files that they include."""
        return tuple(self._prepared)

    @property
    def made(self) -> dict[Path, Path]:
        """Original of each copy, for messages that name the copy."""
        return {copy: file for file, copy in self._prepared.items() if copy != file}

    def prepared(self, file: Path) -> Path:
        """Return the file to give to SUMO instead of ``file``: itself, unless it must be copied.

        Raises:
            ScenarioError: the file, or one that it includes, cannot be read.
        """
        if file in self._prepared:
            return self._prepared[file]
        self._prepared[file] = file  # a file that includes itself is SUMO's to refuse
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
        """Return the place of the output ``name`` of ``named_in`` in the results folder."""
        return str(self._outputs.place(located(name, named_in)))


class _Editor:
    """Finds the changes for the copy of one file."""

    def __init__(self, file: Path, copies: Copies) -> None:
        self._file = file
        self._copies = copies
        self.needed = False  # whether an output was found, here or in an included file

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
        if key == "file" and parent == "tlLogic" and is_file(value):  # an actuated one's detectors
            return {"value": self._redirected(value, self._file)}
        return {}

    def _redirected(self, name: str, named_in: Path) -> str:
        self.needed = True
        return self._copies.redirected(name, named_in)


def _has_signs(file: Path) -> bool:
    """Return whether the file can name an output at all; reads it once, in pieces."""
    return any(sign in text for text in pieces(file) for sign in _SIGNS)
