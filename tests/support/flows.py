"""Flows of people for runs: over the plaza and over a street."""

from __future__ import annotations

NORTH = {
    "name": "north",
    "from": [[18.0, -16.0], [36.0, -16.0]],
    "to": [18.0, 14.0, 36.0, 16.0],
    "rate": 2400.0,
    "begin": -40.0,
}


SOUTH = {"name": "south", "from": NORTH["to"], "to": NORTH["from"], "rate": 1200.0, "begin": -40.0}


PLAZA = {"scenario": "shared_space", "seed": 3, "crowd": {"pedestrians": 0, "flow": [NORTH, SOUTH]}}


ACROSS = {
    "name": "across",
    "from": [58.0, -6.2, 76.0, -3.8],
    "to": [58.0, 3.8, 76.0, 6.2],
    "rate": 1800.0,
    "begin": -10.0,
}


STREET = {
    "scenario": "street",
    "seed": 3,
    "crowd": {"pedestrians": 0, "flow": [ACROSS]},
    "regulation": {"reference_speed": 4.0},  # long enough for many to come
}


def with_crowd(config: dict, **crowd: object) -> dict:
    return {**config, "crowd": {**config["crowd"], **crowd}}
