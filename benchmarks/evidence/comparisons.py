"""How the default compares with its rival, scene by scene: margins, and the delay that it saves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from tables import Column, Tables, difference_text, header, row
from weights import SAVING, SCENES, free

from giveway.studies.statistics.bootstrap import seed_of

DEFAULT, RIVAL = "mpc", "pid-tuned"
MARGINS = {
    "completion_time": ("time [s]", 0.3),
    "longest_wait": ("longest wait [s]", 0.3),
    "rms_jerk": ("RMS jerk [m/s³]", 0.2),
    "people_below_ttc": ("people below 1.5 s", 0.2),
    "share_below_ttc": ("TTC < 1.5 s", 0.03),
    "share_below_pet": ("PET < 1 s", 0.02),
    "share_below_pet_person_first": ("of these, the ego after the person", 0.02),
    "mean_people_delay": ("people's mean delay [s]", 0.2),
}
"""How much worse the default may be: title and margin [unit of the metric]."""
STREET_BELOW_TTC = 0.4
"""Margin for people below the TTC limit on the street."""
DIFFERENCES = (
    "completion_time",
    "longest_wait",
    "rms_jerk",
    "people_below_ttc",
    "mean_people_delay",
)
RESAMPLES = 10_000


def _by_scene(folder: Path) -> tuple[list[str], pd.DataFrame]:
    compared = Tables(folder).compared
    kept = compared[compared.treatment == DEFAULT]
    return list(kept.scene.drop_duplicates()), kept.set_index(["scene", "metric"])


def differences(folder: Path) -> list[str]:
    """Paired differences of the default from its rival, with intervals and signs."""
    scenes, by = _by_scene(folder)
    lines = header(["scene", *(MARGINS[metric][0] for metric in DIFFERENCES)])
    for scene in scenes:
        found = (
            by.loc[(scene, metric)] if (scene, metric) in by.index else None
            for metric in DIFFERENCES
        )
        lines.append(row([scene, *(difference_text(each, Column("", "", 2)) for each in found)]))
    return lines


def margins(folder: Path) -> list[str]:
    """Whether the upper end of each difference's interval is within its margin.

    Where it is not, the difference stands with its interval, in bold if all of that is beyond.
    """
    scenes, by = _by_scene(folder)
    lines = header(["scene", *(f"{title} (+{margin:g})" for title, margin in MARGINS.values())])
    for scene in scenes:
        texts = [scene]
        for metric, (_, margin) in MARGINS.items():
            street = metric == "people_below_ttc" and scene.startswith("street")
            key = (scene, metric)
            texts.append(_verdict(by.loc[key], STREET_BELOW_TTC if street else margin)
                         if key in by.index else "-")  # fmt: skip
        lines.append(row(texts))
    return lines


def _verdict(difference: pd.Series, margin: float) -> str:
    if pd.isna(difference.ci_high):
        return "-"
    if difference.ci_high <= margin:
        return "yes"
    low, high = difference.ci_low, difference.ci_high
    text = f"{difference.mean_difference:+.2f} [{low:+.2f}, {high:+.2f}]"
    return f"**{text}**" if low > margin else text


def saved(folder: Path) -> list[str]:
    """How much of the rival's delay the default saves, in scenes where that delay is large.

    A delay is the time beyond the drive with nobody about. The interval is a bootstrap over seeds:
    everything of one seed is one sample.
    """
    by = Tables(folder).runs.set_index(["scene", "controller", "seed"]).sort_index()
    delays, savings, critical = {}, {}, {}
    for scene in SAVING:
        theirs, ours = by.loc[(scene, RIVAL)], by.loc[(scene, DEFAULT)]
        delays[scene] = theirs.completion_time - free(SCENES[scene])
        savings[scene] = theirs.completion_time - ours.completion_time
        critical[scene] = ours.people_below_ttc - theirs.people_below_ttc
    titles = ["scene", "crowds", f"delay of `{RIVAL}` [s]", "of it saved"]
    titles += ["people below 1.5 s, `mpc` more"]
    lines = header(titles)
    for name, scenes in [(scene, [scene]) for scene in SAVING] + [("all five", list(SAVING))]:
        delay, saving, more = (
            pd.concat([of[scene] for scene in scenes], axis=1).dropna().to_numpy().sum(axis=1)
            for of in (delays, savings, critical)
        )
        g = np.random.default_rng(seed_of([name, "saved"]))
        drawn = g.integers(0, len(delay), (RESAMPLES, len(delay)))
        share = saving[drawn].sum(axis=1) / delay[drawn].sum(axis=1)
        low, high = 100.0 * np.percentile(share, (2.5, 97.5))
        few, many = np.percentile(more[drawn].mean(axis=1) / len(scenes), (2.5, 97.5))
        lines.append(
            row(
                [
                    name,
                    str(len(delay)),
                    f"{delay.mean() / len(scenes):.1f}",
                    f"{100.0 * saving.sum() / delay.sum():.0f} % [{low:.0f}, {high:.0f}]",
                    f"{more.mean() / len(scenes):+.2f} [{few:+.2f}, {many:+.2f}]",
                ]
            )
        )
    return lines
