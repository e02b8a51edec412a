"""Where SUMO's outputs go instead of beside the scenario."""

from collections.abc import Mapping
from pathlib import Path, PurePath

from giveway.errors import ResultsError

_NOWHERE = frozenset({"stdout", "stderr", "-", "nul", "/dev/null", "/dev/stdout", "/dev/stderr"})


def is_file(name: str) -> bool:
    """Whether an output of this name is a file, and not a stream, nothing or a network address."""
    colon = name.find(":")  # SUMO takes host:port for an address; C: is a drive
    return bool(name.strip()) and name.strip().lower() not in _NOWHERE and colon <= 1


class OutputFolder:
    """Gives every file that SUMO would write a name of its own in one folder.

    Args:
        folder: the folder; created with the first file.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder.absolute()
        self._placed: dict[Path, Path] = {}
        self._taken: set[str] = set()

    @property
    def placed(self) -> Mapping[Path, Path]:
        """Each file that the scenario names, to the file that is written instead."""
        return self._placed

    def place(self, original: Path) -> Path:
        """The file to write instead of ``original``; the same one at each call.

        Raises:
            ResultsError: SUMO cannot write into this folder.
        """
        if original not in self._placed:
            self._placed[original] = self._prepared() / self._free_name(original)
        return self._placed[original]

    def _free_name(self, original: PurePath) -> str:
        """The original's own name, or with its folders' names in front if that is taken."""
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
