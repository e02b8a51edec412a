"""The command ``giveway validate`` compares the pedestrian model with trajectories."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pandas as pd

from giveway.errors import DatasetError
from giveway.recordings.intervals import ClipBootstrap
from giveway.validation.clips import Clip
from giveway.validation.contacts import contact_table, people_apart
from giveway.validation.evaluation import Evaluation, error_table, evaluate
from giveway.validation.prediction import predict_all, prediction_table
from giveway.validation.predictors import predictors
from giveway.validation.protocol import Protocol, Window, windows
from pedestrian_model import VciParameters
from pedestrian_model.drift.trained import unseen_fit

Progress = Callable[[int, int], None]  # numbers of windows done and of all

SEED = 0  # seed of the bootstrap's draws


@dataclass(frozen=True, eq=False)
class Validation:
    """The results of a validation.

    Attributes:
        errors: Table, see :func:`giveway.validation.evaluation.error_table`.
        contacts: Table, see :func:`giveway.validation.contacts.contact_table`.
        apart: Distances, see :func:`giveway.validation.contacts.people_apart`.
        prediction: Table, see :func:`giveway.validation.prediction.prediction_table`; empty if each
            fit of drift has seen one of the clips.
        fit: Name of the fit of drift, or empty.
    """

    clips: tuple[Clip, ...]
    cut: tuple[Window, ...]
    protocol: Protocol
    draws: ClipBootstrap
    found: Evaluation
    errors: pd.DataFrame
    contacts: pd.DataFrame
    apart: dict[str, float]
    prediction: pd.DataFrame
    fit: str

    @property
    def pedestrians(self) -> int:
        """The number of recorded pedestrians in all clips."""
        return sum(len(clip.ids) for clip in self.clips)


def validate(
    clips: Sequence[Clip],
    parameters: VciParameters,
    *,
    protocol: Protocol | None = None,
    progress: Progress = lambda _done, _all: None,
) -> Validation:
    """Predict all windows of the clips, and replay whole clips.

    Args:
        clips: Clips from :func:`giveway.validation.read_clips`.
        parameters: Parameters of the pedestrian model.
        protocol: Rules for cutting and judging clips, or None for those of :func:`protocol_of`.
        progress: Function of the number of windows done and of all.

    Raises:
        DatasetError: no clip is long enough.
    """
    clips = tuple(clips)
    protocol = protocol or protocol_of(clips)
    cut = cut_windows(clips, protocol)
    replays = sum(clip.poses.shape[1] > 0 for clip in clips)
    done = 0

    def advance() -> None:
        nonlocal done
        done += 1
        progress(done, len(cut) + replays)

    by = predictors(parameters, protocol.time_step, protocol.longest)
    found = evaluate(cut, by, protocol, len(clips), advance)
    draws = ClipBootstrap.of(len(clips), SEED)
    errors = error_table(found, protocol, draws)
    contacts = contact_table(clips, parameters, protocol, advance)
    apart = people_apart(clips, parameters, protocol)
    fit, prediction = unseen_fit([clip.name for clip in clips]), pd.DataFrame()
    if fit is not None:
        prediction = prediction_table(predict_all(cut, fit, protocol), protocol, draws)
    name = "" if fit is None else fit.name
    return Validation(clips, cut, protocol, draws, found, errors, contacts, apart, prediction, name)


def protocol_of(clips: Sequence[Clip]) -> Protocol:
    """Return the protocol of the data set that the clips belong to.

    Raises:
        DatasetError: they belong to several data sets, or there are none.
    """
    datasets = list(dict.fromkeys(clip.dataset for clip in clips))
    if len(datasets) != 1:
        names = ", ".join(dataset.name for dataset in datasets) or "none"
        raise DatasetError(f"clips: from the data sets {names}; expected those of one at a time")
    return Protocol.of(datasets[0])


def cut_windows(clips: tuple[Clip, ...], protocol: Protocol) -> tuple[Window, ...]:
    """Return the windows of the clips.

    Raises:
        DatasetError: there is no window.
    """
    cut = windows(clips, protocol)
    if not cut:
        needed = protocol.skip + min(protocol.horizons) + 1
        longest = max((clip.frames for clip in clips), default=0)
        raise DatasetError(
            f"clips: the longest has {longest} frames: expected at least {needed} in which "
            f"somebody is seen ({protocol.skip} are skipped, {min(protocol.horizons)} predicted)"
        )
    return cut
