"""The pictures of a risk: its convergence, and the region of the inputs in which the event lies."""

from collections import defaultdict

import numpy as np
from matplotlib.figure import Figure

from giveway.errors import ResultsError, remedy
from giveway.figures.studies.risk_figure import (
    Bounds,
    convergence_figure,
    levels_figure,
    region_figure,
)
from giveway.figures.style import save_figure
from giveway.risk.causes import conditions
from giveway.risk.estimators import clopper_pearson
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.tables import plain_runs

_POINTS = 60  # Number of estimates that are drawn
_DRAWN = 2000  # Largest number of runs of either kind in the picture of the region


def write_pictures(folder: RiskFolder) -> None:
    """Write the pictures into the folder ``figures``.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    place = folder.path / "figures"
    for name, figure in pictures(folder).items():
        path = place / f"{name}.png"
        try:
            place.mkdir(exist_ok=True)
            save_figure(figure, path)
        except OSError as error:
            raise ResultsError(
                f"{path}: cannot be written ({error.strerror}); {remedy(error)}"
            ) from error


def pictures(folder: RiskFolder) -> dict[str, Figure]:
    """Return the pictures by their names: ``convergence``, and ``region`` where it is known."""
    definition, estimate = folder.plan.definition, folder.estimate
    title = f"{definition.name}: {definition.event}"
    region = _region(folder, title)
    drawn = {} if region is None else {"region": region}
    if definition.method == "monte-carlo":
        return {"convergence": convergence_figure(_bounds(folder), title), **drawn}
    repeats: defaultdict[int, list[tuple[float, float]]] = defaultdict(list)
    for stage in estimate.stages:
        repeats[stage.repeat].append((stage.level, stage.probability))
    interval = estimate.low, estimate.high
    return {"convergence": levels_figure([*repeats.values()], interval, title), **drawn}


def _region(folder: RiskFolder, title: str) -> Figure | None:
    """Return the plane of the two inputs with the largest indices; None if they are not known."""
    known = [one.component for one in conditions(folder) if one.component.is_number]
    sample = folder.estimate.sample
    if len(known) < 2 or sample is None:
        return None
    plain = folder.runs[plain_runs(folder)] or folder.runs
    others = [made[0].vector for made in plain if folder.plan.criticality(*made) < 0.0][:_DRAWN]
    met = sample.vectors[:: 1 + len(sample.vectors) // _DRAWN]
    first, second = known[:2]

    def placed(vectors: np.ndarray) -> np.ndarray:
        return np.column_stack([one.values(vectors[:, one.number]) for one in (first, second)])

    rest = np.array(others).reshape(-1, sample.vectors.shape[1])
    return region_figure(placed(rest), placed(met), (first.name, second.name), title)


def _bounds(folder: RiskFolder) -> list[Bounds]:
    """Return the estimate after more and more runs of plain Monte Carlo."""
    met = [folder.plan.criticality(*made) >= 0.0 for made in folder.runs]
    counts = np.cumsum(met)
    confidence = folder.plan.definition.confidence
    sizes = np.unique(np.geomspace(min(10, len(met)), len(met), _POINTS).astype(int))
    return [
        Bounds(int(n), counts[n - 1] / n, *clopper_pearson(int(counts[n - 1]), int(n), confidence))
        for n in sizes
    ]
