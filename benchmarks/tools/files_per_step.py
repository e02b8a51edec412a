"""The files whose functions run in one control step: what a newcomer opens to follow it.

Run: python benchmarks/tools/files_per_step.py [SCENARIO] [--controller NAME]

``sys.setprofile`` tells every Python function that is called between two control steps. The most
that one step calls is shown; compiled kernels run inside their callers and are not seen.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import giveway

if TYPE_CHECKING:
    from types import FrameType

HOUSE = Path(giveway.__file__).parent.parent
ROOMS = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")


class StepFiles:
    """Collects, as a watcher of a run, the files of each control step."""

    def __init__(self) -> None:
        self.steps: list[set[str]] = []
        self._seen: set[str] = set()

    def __call__(self, _progress: Any) -> None:
        """The next control step begins."""
        sys.setprofile(None)
        self.steps.append(self._seen)
        self._seen = set()
        sys.setprofile(self._note)

    def _note(self, frame: FrameType, event: str, _argument: Any) -> None:
        if event == "call":
            self._seen.add(frame.f_code.co_filename)


def files_of(scenario: str, controller: str) -> list[str]:
    """The files of the control step that needs the most of them."""
    settings = {"scenario": scenario, "controller": controller, "time_limit": 20.0}
    if scenario == "shared_space":
        settings["crowd"] = {"pedestrians": 30}
    giveway.run(settings)  # loads the machine code that is first needed in the midst of a run
    watcher = StepFiles()
    try:
        giveway.run(settings, watcher=watcher)
    finally:
        sys.setprofile(None)
    # The first steps set things up; the last set belongs to the end of the run.
    ours = [sorted(filter(None, map(_place, step))) for step in watcher.steps[3:]]
    return max(ours, key=len)


def _place(file: str) -> str | None:
    path = Path(file)
    if not path.is_relative_to(HOUSE):
        return None
    place = path.relative_to(HOUSE)
    return place.as_posix() if place.parts[0] in ROOMS else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", nargs="?", default="shared_space")
    parser.add_argument("--controller", default="mpc")
    options = parser.parse_args()
    files = files_of(options.scenario, options.controller)
    print(f"{options.scenario}, {options.controller}: {len(files)} files in one control step")
    print("\n".join(f"  {file}" for file in files))


if __name__ == "__main__":
    main()
