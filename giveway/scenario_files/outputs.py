"""The places of SUMO's outputs: in the results folder instead of beside the scenario."""

from collections.abc import Mapping
from pathlib import Path, PurePath

from giveway.errors import ResultsError

_NOWHERE = frozenset({"stdout", "stderr", "-", "nul", "/dev/null", "/dev/stdout", "/dev/stderr"})


def is_file(name: str) -> bool:
    """Return whether an output of this name is a file, not a stream, address or nothing."""
    colon = name.find(":")  # SUMO takes host:port for an address; C: is a drive
    return bool(name.strip()) and name.strip().lower() not in _NOWHERE and colon <= 1


class OutputFolder:
    """The results folder, in which every file that SUMO would write gets a name of its own.

    Args:
        folder: Path of the folder, which is created with the first file.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder.absolute()
        self._placed: dict[Path, Path] = {}
        self._taken: set[str] = set()

    @property
    def placed(self) -> Mapping[Path, Path]:
        """The files that are written, by the files that the scenario names."""
        return self._placed

    def place(self, original: Path) -> Path:
        """Return the file to write instead of ``original``, which is the same at each call.

        Raises:
            ResultsError: SUMO cannot write into this folder.
        """
        if original not in self._placed:
            self._placed[original] = self._prepared() / self._free_name(original)
        return self._placed[original]

    def _free_name(self, original: PurePath) -> str:
        """Return the original's name, preceded by its folders' names if it is taken."""
        name = original.name
        folders = [part for part in reversed(original.parts[1:-1]) if part]
        for folder in folders:
            if name.casefold() not in self._taken:
                break
            name = f"{folder}-{name}"
        number = 1
        while name.casefold() in self._taken:
            number += 1
            name = f"{number}-{original.name}"
        self._taken.add(name.casefold())
        return name

    def _prepared(self) -> Path:
        if not is_file(str(self.folder)):
            raise ResultsError(
                f"{self.folder}: SUMO takes the ':' for a network address and cannot write there; "
                "choose a results folder without one"
            )
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultsError(
                f"{self.folder}: cannot be made for SUMO's outputs ({error.strerror}); name another"
            ) from error
        return self.folder
