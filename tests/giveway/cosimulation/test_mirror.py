"""The mirror: SUMO has whoever we have, and nobody else."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import libsumo
import pytest

import giveway
from giveway.run_data.progress import Progress


def test_who_has_arrived_is_gone_from_sumo_too() -> None:
    mirrored: list[int] = []

    def count(progress: Progress) -> None:
        if progress.time > 0.0:
            mirrored.append(len(libsumo.person.getIDList()) - progress.pedestrians)

    result = giveway.run(
        {"seed": 2, "crowd": {"pedestrians": 12, "walk": (0.0, 6.0)}}, watcher=count
    )
    assert result.manifest["pedestrians"]["arrived"] > 0
    assert set(mirrored) == {0}


def test_somebody_elses_move_of_our_walkers_is_noticed(city: Callable[[float], Path]) -> None:
    seen: list[str] = []
    native = libsumo.libsumo._libsumo
    step = native.simulation_step

    def meddle(*arguments: Any) -> Any:
        done = step(*arguments)
        if libsumo.simulation.getTime() > 113.0 and not seen:
            seen.append("ped0")
            libsumo.person.moveTo("ped0", libsumo.person.getLaneID("ped0"), 3.0)
        return done

    config = {"ego": {"take_over": ("car10",)}, "crowd": {"zone": "everywhere"}}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(native, "simulation_step", meddle)
        with pytest.raises(giveway.GivewayError, match=r"person 'ped0' at 11.*away from our state"):
            giveway.run({"scenario": str(city(0.1)), "time_limit": 10.0, **config})
