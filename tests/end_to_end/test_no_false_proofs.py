"""Drives in which the paper's MPC once refused a plan that its last plan had led to."""

import pytest

import giveway

# People and seeds of all 13 among 6,000 drives. At the end of hard braking the plan stood on its
# bounds, a proof found the next problem infeasible by 1e-16 m/s, and the PID sped up at full force.
DRIVES = [
    *((30, seed) for seed in (15, 50, 741, 1752, 1776, 1977)),
    *((20, seed) for seed in (521, 705, 931, 1811, 1948)),
    *((10, seed) for seed in (436, 1535)),
]


@pytest.mark.parametrize(("people", "seed"), DRIVES)
def test_a_plan_on_its_speed_bounds_has_a_successor(people, seed):
    settings = {"controller": "mpc-paper", "seed": seed, "crowd": {"pedestrians": people}}
    status = giveway.run(settings).ego["solver_status"]
    refused = status[status != "solved"]
    assert (status == "solved").any()
    assert refused.empty or refused.iloc[0] == "infeasible: cannot stop"
