"""The pictures of a risk: its convergence."""

from collections import defaultdict
from pathlib import Path

import numpy as np

from giveway.errors import ResultsError, remedy
from giveway.figures.studies.risk_figure import Bounds, convergence_figure, levels_figure
from giveway.figures.style import save_figure
from giveway.risk.estimators import clopper_pearson
from giveway.risk.risk_folder import RiskFolder

_POINTS = 60  # Number of estimates that are drawn


def write_pictures(folder: RiskFolder) -> Path:
    """Write the picture of the convergence, and return its path.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    definition, estimate = folder.plan.definition, folder.estimate
    title = f"{definition.name}: {definition.event}"
    interval = estimate.low, estimate.high
    if definition.method == "monte-carlo":
        figure = convergence_figure(_bounds(folder), title)
    else:
        repeats: defaultdict[int, list[tuple[float, float]]] = defaultdict(list)
        for stage in estimate.stages:
            repeats[stage.repeat].append((stage.level, stage.probability))
        figure = levels_figure([*repeats.values()], interval, title)
    path = folder.path / "figures" / "convergence.png"
    try:
        path.parent.mkdir(exist_ok=True)
        save_figure(figure, path)
    except OSError as error:
        raise ResultsError(
            f"{path}: cannot be written ({error.strerror}); {remedy(error)}"
        ) from error
    return path


def _bounds(folder: RiskFolder) -> list[Bounds]:
    """Return the estimate after more and more runs of plain Monte Carlo."""
    met = [folder.plan.criticality(record) >= 0.0 for _, record in folder.runs]
    counts = np.cumsum(met)
    confidence = folder.plan.definition.confidence
    sizes = np.unique(np.geomspace(min(10, len(met)), len(met), _POINTS).astype(int))
    return [
        Bounds(int(n), counts[n - 1] / n, *clopper_pearson(int(counts[n - 1]), int(n), confidence))
        for n in sizes
    ]
