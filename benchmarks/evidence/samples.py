"""Studies and samples behind the pages: all settings, seeds and sample sizes are here.

docs/evidence.md has the arithmetic. Studies that a bundled file defines are named; the others
stand here. Scenes, levels and drivers that no page speaks of are left out.
"""

from __future__ import annotations

from typing import Any

from work import Study

CROWD: dict[str, Any] = {"crowd": {"pedestrians": 30}}
TWO_SIDED: dict[str, Any] = {"crowd": {"pedestrians": 30, "two_sided": True}}
ENCOUNTER: dict[str, Any] = {"scenario": "encounter", "crowd": {"pedestrians": 24}}
UNSAFE: dict[str, Any] = {"safety": {"enabled": False}}


def crowded(people: int, *, sides: int = 1, **crowd: Any) -> dict[str, Any]:
    """Settings of a crowd on the open plaza."""
    return {"crowd": {"pedestrians": people, "two_sided": sides == 2, **crowd}}


ROADS = ["junction", "crossings"]
SCENES = ["one-sided, 30", "one-sided, 60", "two-sided, 10", "two-sided, 30", "two-sided, 60",
          "stream, 30", "stream, 60", "street, 30", "encounter, medium", "encounter, dense",
          "encounter, unknown goals", "unseen speeds, 30", "SIM crowd, 30", "TABLE2 crowd, 30",
          "position noise, 30"]  # fmt: skip
RIVALS = ["mpc", "pid-tuned"]

CONTROLLERS = Study(
    "controllers", 50, twin=True, changes={"only": {"scene": SCENES, "controller": RIVALS}}
)
ON_ROADS = Study("controllers", 50, changes={"only": {"scene": ROADS, "controller": RIVALS}})
ATTITUDES = Study("styles", 50, twin=True)
ABLATION = Study(
    "ablation",
    60,
    first_seed=1,
    changes={"comparison": {"factor": "variant", "baseline": "mpc"}},
)
MODELS = Study(
    "models",
    30,
    twin=True,
    changes={"only": {"driver": ["mpc", "pid-tuned", "idm", "careful-driver"]}},
)
PEOPLE_MODELS = ("vci", "social-force", "gap-acceptance", "orca", "constant-velocity")
BELIEFS = Study(
    "beliefs",
    24,
    first_seed=301,
    twin=True,
    changes={
        "cells": [
            {"scene": scene, "people": people, "belief": belief}
            for scene in ("crowd", "encounter")
            for people in PEOPLE_MODELS
            for belief in dict.fromkeys(("vci", people, "constant-velocity"))
        ]
    },
)
LAW = Study("law", 60, first_seed=1)
FIRST_DRIVES = Study(
    {"name": "encounter", "run": {"scenario": "encounter"}, "factors": {"controller": ["mpc"]}},
    20,
    first_seed=1,
)
ASSUMPTIONS = Study(
    {
        "name": "assumptions",
        "factors": {
            "scene": {
                "one-sided, 30": CROWD,
                "two-sided, 30": TWO_SIDED,
                "encounter, 24": ENCOUNTER,
            },
            "controller": ["pid-tuned", "mpc"],
            "people": {
                name: {"safety": {"people": name}}
                for name in ("worst-case", "recorded-99.9", "responsible")
            },
        },
        "comparison": {"factor": "people", "baseline": "worst-case"},
    },
    40,
    first_seed=1,
)
NOISE = Study(
    {
        "name": "noise",
        "run": CROWD,
        "factors": {
            "controller": RIVALS,
            "seen": {
                "exactly": {},
                "raw": {"perception": {"position_noise": 0.1, "tracker": False}},
                "tracked": {"perception": {"position_noise": 0.1}},
            },
        },
        "comparison": {"factor": "seen", "baseline": "exactly"},
    },
    60,
    first_seed=301,
)
LAYER = Study(
    {
        "name": "layer",
        "factors": {
            "scene": {
                "one-sided, 30": CROWD,
                "one-sided, 60": crowded(60),
                "two-sided, 30": TWO_SIDED,
                "two-sided, 60": crowded(60, sides=2),
                "street, 60": {"scenario": "street", "crowd": {"pedestrians": 60}},
            },
            "controller": ["mpc-paper", "pid-paper"],
            "layer": {
                "off": UNSAFE,
                "on": {"safety": {"enabled": True}},
            },
        },
        "comparison": {"factor": "layer", "baseline": "off"},
    },
    40,
    first_seed=1,
)


def _tuned(**changes: Any) -> dict[str, Any]:
    reference = {"profile": "braking-curve", "deceleration": 2.0, "jerk": 10.0,
                 "acceleration": 3.0, "last_distance": 2.0}  # fmt: skip
    return {"controller": "pid-tuned", "controller_options": reference | changes}


PROFILES = Study(
    {
        "name": "profiles",
        "run": UNSAFE,
        "factors": {
            "scene": {
                "one-sided, 30": CROWD,
                "street, 30": {"scenario": "street", **CROWD},
            },
            "profile": {
                "pid-paper": {"controller": "pid-paper"},
                "curve, b = 1": _tuned(deceleration=1.0),
                "curve, b = 2": _tuned(),
                "curve, b = 3": _tuned(deceleration=3.0),
                "linear, b = 2": _tuned(profile="linear"),
                "jerk 5": _tuned(jerk=5.0),
                "jerk 20": _tuned(jerk=20.0),
                "acceleration 2": _tuned(acceleration=2.0),
                "last distance 4": _tuned(last_distance=4.0),
            },
        },
        "comparison": {"factor": "profile", "baseline": "curve, b = 2"},
    },
    40,
    first_seed=1,
)
PAPER = Study("paper", 2000, first_seed=1)
READINGS = Study("readings", 200, first_seed=1)
