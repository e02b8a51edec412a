"""What the clairvoyant front's rows of drives and motions say, scene by scene and pooled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd

from giveway.studies.statistics.bootstrap import mean_interval, seed_of

BASELINE = "pid-tuned"
DRIVEN, FRONT, NO_WORSE = "driven", "front", "nobody worse off"
POOLED = "all five pooled"
MARGIN = 0.02  # by so much the share may be larger than the baseline's
ENOUGH, IN_EACH = 0.4, 0.25  # of the baseline's delay, to be saved: pooled, and in each scene
RESAMPLES = 2000


class Mean(NamedTuple):
    """A mean and its 95 % interval."""

    value: float
    low: float
    high: float

    @property
    def percent(self) -> str:
        """As a part of something."""
        return f"{100 * self.value:.0f} % [{100 * self.low:.0f}, {100 * self.high:.0f}]"

    @property
    def difference(self) -> str:
        """As more or less than something."""
        return f"{self.value:+.2f} [{self.low:+.2f}, {self.high:+.2f}]"


class Group:
    """Crowds of one scene, or of all: means over crowds, those of scenes with equal weight."""

    def __init__(self, name: str, rows: pd.DataFrame) -> None:
        self.name = name
        self.rows = rows
        scenes = list(rows.groupby("scene", sort=False))
        self.parts = [self] if len(scenes) == 1 else [Group(str(n), each) for n, each in scenes]
        base = rows[(rows.motion == DRIVEN) & (rows.recording == BASELINE)]
        self.base = base.set_index("seed").sort_index()
        # Everything of one seed is one sample: the scenes of a seed are drawn together.
        self.seeds = np.unique(self.base.index)
        by = self.base.groupby(level=0)
        self.delay = (by.time.mean() - by.free.mean()).to_numpy()
        self.share = by.share.mean().to_numpy()

    def means(self, recording: str, motion: str) -> pd.DataFrame:
        """By seed: time, share, met, contact of a drive or of the motion of a case."""
        return _by_seed(self._of(recording, motion))

    def ends(self, recording: str) -> tuple[pd.DataFrame, pd.DataFrame]:
        """By seed: the fastest motion of a front, and the one that meets the fewest."""
        crowds = self._of(recording, FRONT).sort_values("time").groupby(["scene", "seed"])
        return _by_seed(crowds.first()), _by_seed(crowds.last())

    def in_each(self, recording: str) -> tuple[pd.DataFrame, pd.DataFrame]:
        """By seed: no larger share than the baseline's in any crowd, at most and at least as long.

        The first is a motion of the front, the second is between two of them; the best of all
        motions, many of which are no vertices, takes a time between these.
        """
        allowed = self.base.set_index("scene", append=True).share
        found, least = [], []
        for (scene, seed), each in self._of(recording, FRONT).groupby(["scene", "seed"]):
            share = allowed[seed, scene]
            slowest = each.sort_values("time").iloc[-1]
            kept = each[each.share <= share + 1e-9]
            found.append(kept.sort_values("time").iloc[0] if len(kept) else slowest)
            front = convex(each[["time", "share"]].to_numpy())
            time = float(np.interp(-share, -front[:, 1], front[:, 0]))
            least.append(slowest.to_dict() | {"time": time, "share": min(share, front[0, 1])})
        return _by_seed(pd.DataFrame(found)), _by_seed(pd.DataFrame(least))

    def _of(self, recording: str, motion: str) -> pd.DataFrame:
        return self.rows[(self.rows.motion == motion) & (self.rows.recording == recording)]

    def saved(self, means: pd.DataFrame) -> Mean:
        """The part of the baseline's delay that is saved."""
        ours = (means.time - means.free).to_numpy()
        return self._resampled(lambda at: 1.0 - ours[at].mean() / self.delay[at].mean())

    def more(self, means: pd.DataFrame) -> Mean:
        """How much larger the share is than the baseline's: paired."""
        return self._more(means.share.to_numpy())

    def _more(self, share: np.ndarray) -> Mean:
        difference = share - self.share
        seed = seed_of([self.name, "share"])
        between = mean_interval(difference, confidence=0.95, resamples=RESAMPLES, seed=seed)
        return Mean(difference.mean(), between.low, between.high)

    def saved_at(self, recording: str, margin: float) -> Mean:
        """What can be saved with a mean share at most ``margin`` above the baseline's, in each."""
        fronts = [part._fronts(recording) for part in self.parts]

        def saved(at: np.ndarray) -> float:
            kept = 0.0
            for part, of in zip(self.parts, fronts, strict=True):
                front = mean_front([f for i in at for f in of[i]])
                allowed = part.share[at].mean() + margin
                kept += float(np.interp(-allowed, -front[:, 1], front[:, 0]))
            return 1.0 - kept / sum(part.delay[at].mean() for part in self.parts)

        return self._resampled(saved)

    def saved_for_certain(self, recording: str) -> float:
        """What is saved where the share's whole interval is within the margin, in each scene."""
        delay = sum(part._delay_for_certain(recording) for part in self.parts)
        return float(1.0 - delay / sum(part.delay.mean() for part in self.parts))

    def _delay_for_certain(self, recording: str) -> float:
        """Of one scene, at the lowest price that brings the interval within the margin [s]."""
        fronts = [front for (front,) in self._fronts(recording)]
        edges = np.concatenate([np.diff(front, axis=0) for front in map(convex, fronts)])
        for price in [0.0, *np.unique(edges[:, 0] / -edges[:, 1]) + 1e-6]:
            chosen = [f[np.argmin(f @ (1.0, price))] for f in fronts]
            time, share = np.array(chosen).T
            if self._more(share).high <= MARGIN:
                break
        return float(time.mean())

    def more_at(self, recording: str, saved: float) -> Mean:
        """How much larger than the baseline's the mean share must be where that is saved."""
        fronts = self._fronts(recording)

        def more(at: np.ndarray) -> float:
            front = mean_front([f for i in at for f in fronts[i]])
            time = (1.0 - saved) * self.delay[at].mean()
            return float(np.interp(time, front[:, 0], front[:, 1])) - self.share[at].mean()

        return self._resampled(more)

    def front(self, recording: str) -> np.ndarray:
        """(V, 2) the mean front: delay [s] and share."""
        return mean_front([front for fronts in self._fronts(recording) for front in fronts])

    def _fronts(self, recording: str) -> list[list[np.ndarray]]:
        """By seed: of each of its crowds the front."""
        of = self._of(recording, FRONT)
        found: dict[int, list[np.ndarray]] = {int(seed): [] for seed in self.seeds}
        for (_, seed), each in of.groupby(["scene", "seed"]):
            found[int(seed)].append(np.column_stack([each.time - each.free, each.share]))
        return list(found.values())

    def _resampled(self, statistic) -> Mean:
        """A statistic of the seeds, and its percentile interval."""
        rng = np.random.default_rng(seed_of([self.name, "resampled"]))
        n = self.seeds.size
        drawn = [statistic(rng.integers(0, n, n)) for _ in range(RESAMPLES // 4)]
        low, high = np.percentile(drawn, [2.5, 97.5])
        return Mean(statistic(np.arange(n)), float(low), float(high))


def mean_front(fronts: list[np.ndarray]) -> np.ndarray:
    """The front of means over crowds, in each of which one may choose another motion.

    Args:
        fronts: of each crowd (V, 2) vertices: what falls and is dear, what it buys.

    Returns:
        (W, 2) vertices: the least mean of the one at each mean of the other.
    """
    start = np.mean([convex(front)[0] for front in fronts], axis=0)
    edges = np.concatenate([np.diff(convex(front), axis=0) for front in fronts])
    prices = edges[:, 0] / -edges[:, 1]
    walked = np.cumsum(edges[np.argsort(prices, kind="stable")], axis=0) / len(fronts)
    return np.concatenate([start[None], start + walked])


def convex(front: np.ndarray) -> np.ndarray:
    """The vertices that are best at some price: the first grows, the second falls, ever dearer."""
    kept: list[np.ndarray] = []
    for point in front[np.lexsort((front[:, 1], front[:, 0]))]:
        if kept and point[1] >= kept[-1][1]:
            continue
        while len(kept) > 1 and _dearer(kept[-2], kept[-1], point):
            kept.pop()
        kept.append(point)
    return np.array(kept)


def _dearer(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> bool:
    """Whether b lies above the line from a to c."""
    return bool((b[0] - a[0]) * (a[1] - c[1]) >= (c[0] - a[0]) * (a[1] - b[1]))


def groups_of(rows: pd.DataFrame) -> list[Group]:
    """The scenes, and all of them."""
    found = [Group(str(name), each) for name, each in rows.groupby("scene", sort=False)]
    return [*found, Group(POOLED, rows)] if len(found) > 1 else found


def _by_seed(rows: pd.DataFrame) -> pd.DataFrame:
    return rows.groupby("seed")[["time", "share", "met", "contact", "free"]].mean()


def show(rows: pd.DataFrame) -> None:
    """Print all tables as Markdown."""
    recordings = list(dict.fromkeys(rows[rows.motion == FRONT].recording))
    drivers = list(dict.fromkeys(rows[rows.motion == DRIVEN].recording))
    *scenes, pooled = groups_of(rows)
    _table("driven by", "time [s]", "delay saved", "PET < 1 s", "more of them")
    for name in drivers:
        means = pooled.means(name, DRIVEN)
        mean, saved = means.mean(), pooled.saved(means).percent
        more = pooled.more(means).difference
        _line(f"`{name}`", f"{mean.time:.1f}", saved, f"{mean.share:.3f}", more)
    _table("scene", "recording", "same share", f"+{MARGIN}", f"+{MARGIN} with its interval",
           f"{100 * ENOUGH:.0f} % saved: more met", "no crowd worse off", NO_WORSE)  # fmt: skip
    for group in (pooled, *scenes):
        for recording in recordings:
            least, most = (group.saved(means).value for means in group.in_each(recording))
            _line(
                group.name,
                recording,
                group.saved_at(recording, 0.0).percent,
                group.saved_at(recording, MARGIN).percent,
                f"{100 * group.saved_for_certain(recording):.0f} %",
                group.more_at(recording, ENOUGH).difference,
                f"{100 * least:.0f} to {100 * most:.0f} %",
                group.saved(group.means(recording, NO_WORSE)).percent,
            )
    beyond = faster_than_front(rows)
    faster = beyond[beyond > 1e-6]
    print(f"\n{faster.size} of {beyond.size} drives are faster than their own recording's front, "
          f"by {faster.max(initial=0.0):.2f} s at most.")  # fmt: skip


def _table(*titles: str) -> None:
    print("\n| " + " | ".join(titles) + " |\n" + "|---" * len(titles) + "|")


def _line(*texts: str) -> None:
    print("| " + " | ".join(texts) + " |")


def faster_than_front(rows: pd.DataFrame) -> np.ndarray:
    """By how much drives are faster than the front of their recording at their share [s]."""
    found = []
    for _, crowd in rows.groupby(["scene", "seed"]):
        driven = crowd[crowd.motion == DRIVEN].set_index("recording")
        for recording, each in crowd[crowd.motion == FRONT].groupby("recording"):
            if recording in driven.index:
                front = convex(each[["time", "share"]].to_numpy())
                drive = driven.loc[recording]
                found.append(np.interp(-drive.share, -front[:, 1], front[:, 0]) - drive.time)
    return np.array(found)
