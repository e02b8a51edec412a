"""``giveway validate``: the pedestrian model against recorded trajectories."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from giveway.errors import DatasetError
from giveway.validation.contacts import contact_table
from giveway.validation.evaluation import Evaluation, error_table, evaluate
from giveway.validation.intervals import ClipBootstrap
from giveway.validation.predictors import predictors
from giveway.validation.protocol import Protocol, windows

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd

    from giveway.validation.clips import Clip
    from giveway.validation.protocol import Window
    from pedestrian_model import VciParameters

    Progress = Callable[[int, int], None]  # done, in all

SEED = 0  # of the bootstrap's draws
CITR = Protocol()


@dataclass(frozen=True, eq=False)
class Validation:
    """The results of a validation.

    Attributes:
        errors: see :func:`giveway.validation.evaluation.error_table`.
        contacts: see :func:`giveway.validation.contacts.contact_table`.
    """

    clips: tuple[Clip, ...]
    cut: tuple[Window, ...]
    protocol: Protocol
    draws: ClipBootstrap
    found: Evaluation
    errors: pd.DataFrame
    contacts: pd.DataFrame

    @property
    def pedestrians(self) -> int:
        """How many were recorded, in all clips."""
        return sum(len(clip.ids) for clip in self.clips)


def validate(
    clips: Sequence[Clip],
    parameters: VciParameters,
    *,
    protocol: Protocol = CITR,
    progress: Progress = lambda _done, _all: None,
) -> Validation:
    """Predict all windows of the clips, and play whole clips again.

    Args:
        clips: as :func:`giveway.validation.read_clips` reads them.
        parameters: of the pedestrian model.
        protocol: how the clips are cut and judged.
        progress: called with how much is done, and of how much.

    Raises:
        DatasetError: no clip is long enough.
    """
    clips = tuple(clips)
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
    return Validation(clips, cut, protocol, draws, found, errors, contacts)


def cut_windows(clips: tuple[Clip, ...], protocol: Protocol) -> tuple[Window, ...]:
    """The windows of the clips.

    Raises:
        DatasetError: there is none.
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
