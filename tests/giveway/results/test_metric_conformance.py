"""The rules that ``giveway check metric`` knows, each broken by a metric that breaks it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest

from giveway.errors import MetricError
from giveway.metrics.plugged_in import DeclaredMetric
from giveway.results.metric_conformance import check_metric
from giveway.run_data.columns import Quantity, columns_of


@dataclass(frozen=True)
class Columns:
    own: Annotated[float, Quantity("m", "some number")]


class Sound:
    """The smallest distance between a person and the bumper's centre."""

    Columns = Columns

    def measure(self, drive: Any) -> Columns:
        track, crowd = drive.track, drive.crowd
        apart = np.hypot(track.front_x[crowd.step] - crowd.x, track.front_y[crowd.step] - crowd.y)
        return Columns(apart.min(initial=np.inf) if len(apart) else np.nan)


class Word(Sound):
    def measure(self, drive: Any) -> Columns:
        return Columns("near")  # type: ignore[arg-type]


class Lonely(Sound):
    def measure(self, drive: Any) -> Columns:
        return Columns(float(drive.crowd.x[0]) - float(drive.track.front_x[0]) * 0.0)


class Counts(Sound):
    calls: ClassVar[list[int]] = [0]

    def measure(self, drive: Any) -> Columns:
        self.calls[0] += 1
        return Columns(float(self.calls[0]))


class Another(Sound):
    latest: ClassVar[list[float]] = [0.0]

    def measure(self, drive: Any) -> Columns:
        before, self.latest[0] = self.latest[0], float(len(drive.crowd.ids))
        return Columns(before)


class First(Sound):
    def measure(self, drive: Any) -> Columns:
        return Columns(float(np.hypot(drive.crowd.vx, drive.crowd.vy)[:1].sum()))


class Eastwards(Sound):
    def measure(self, drive: Any) -> Columns:
        return Columns(float(drive.track.front_x[-1]))


class Writer(Sound):
    def measure(self, drive: Any) -> Columns:
        drive.track.speed[:] = 1.0
        return Columns(1.0)


def broken(kind: Any) -> dict[str, str]:
    def made() -> DeclaredMetric:
        return DeclaredMetric("it", kind, None, columns_of(kind.Columns))

    return {found.rule: found.problem for found in check_metric(made) if found.problem}


def test_a_sound_metric_breaks_no_rule() -> None:
    assert broken(Sound) == {}


@pytest.mark.parametrize(
    ("kind", "rule"),
    [
        (Word, "answers with its columns"),
        (Lonely, "answers in corner cases"),
        (Counts, "is the same when it is made again"),
        (Another, "is independent of others of its kind"),
        (First, "does not depend on the order of people"),
        (Eastwards, "does not depend on where and how the road lies"),
        (Writer, "changes nothing of the drive"),
    ],
)
def test_each_rule_is_broken_by_a_metric_that_breaks_it(kind: Any, rule: str) -> None:
    found = broken(kind)
    assert rule in found
    assert found[rule].isprintable()


def test_columns_that_cannot_be_used_are_told() -> None:
    def refused() -> DeclaredMetric:
        raise MetricError("no columns")

    (found,) = check_metric(refused)
    assert (found.rule, found.problem) == ("declares its columns", "no columns")
