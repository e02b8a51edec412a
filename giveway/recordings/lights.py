"""The check of a recording's file of traffic lights: found, and its codes known."""

from pathlib import Path

import pandas as pd

from giveway.recordings.dataset import LightFile
from giveway.recordings.recording import LIGHTS, Defect
from giveway.recordings.tables import read_csv


def light_defects(root: Path, lights: LightFile | None) -> list[Defect]:
    """Return what is wrong with the lights of the recording in a folder.

    Args:
        root: Folder of the recording.
        lights: Description of the files, or None if the data set has none.

    Raises:
        DatasetError: the file cannot be read.
    """
    if lights is None:
        return []
    files = sorted({file for pattern in lights.files for file in root.glob(pattern)})
    if not files:
        return [Defect(LIGHTS, 1, f"no file {' or '.join(lights.files)}")]
    found = []
    for file in files:
        table = read_csv(file)
        columns = [name for name in table if lights.columns in str(name).lower()]
        if not columns:
            found.append(Defect(LIGHTS, 1, f"{file.name}: no column with '{lights.columns}'"))
            continue
        codes = table[columns].apply(pd.to_numeric, errors="coerce").to_numpy()
        unknown = ~pd.DataFrame(codes).isin(lights.codes).to_numpy()
        if unknown.any():
            known = ", ".join(str(code) for code in lights.codes)
            text = f"{file.name}: code {codes[unknown][0]:g}; known are {known}"
            found.append(Defect(LIGHTS, int(unknown.sum()), text))
    return found
