"""What the campaign mutates: scenarios, settings, vehicles, clips, presets, results.

All of it is in the repository, or made here from it, once for each ``--out``.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import zipfile
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from campaign_texts import (
    ADDITIONAL,
    CROWDS,
    DATASET,
    DEMAND,
    JOURNAL,
    LEVELS,
    PRECISE,
    PROFILE,
    STUDY,
    TOWN,
)

if TYPE_CHECKING:
    from campaign_nursery import Ended, Nursery

SCENARIOS: Final = ("shared_space", "street", "junction")
FMUS: Final = ("LongitudinalVehicle.fmi2.fmu", "LongitudinalVehicle.fmi3.fmu")
KERNELS_RUN: Final = (
    "run",
    "shared_space",
    "--pedestrians",
    3,
    "--time-limit",
    0.2,
    "--no-pictures",
)
LIMIT: Final = 300  # [s] for making one of them
_RATE: Final = 29.97  # [1/s] of the clips


class Bases:
    """Makes each kind of input when it is first asked for.

    Args:
        folder: for them; what is there already is used again.
        nursery: types the commands that make some of them.
    """

    def __init__(self, folder: Path, nursery: Nursery) -> None:
        self._folder, self._nursery = folder, nursery
        folder.mkdir(parents=True, exist_ok=True)

    @cached_property
    def scenarios(self) -> dict[str, Path]:
        """Folders by the names of their .sumocfg."""
        import sumo_scenarios

        root = Path(sumo_scenarios.__file__).parent
        found = {}
        for name in SCENARIOS:
            suffixes = ("sumocfg", "net.xml", "rou.xml", "giveway.toml")
            files = [root / name / f"{name}.{suffix}" for suffix in suffixes]
            found[name] = self._folder / name
            found[name].mkdir(exist_ok=True)
            for file in files:
                if file.exists():
                    shutil.copy(file, found[name])
        return found | {"town": self._town()}

    def _town(self) -> Path:
        """Four junctions with sidewalks, crossings and lights; a bus, stops, people, a rerouter."""
        import sumo

        folder = self._folder / "town"
        if (folder / "town.sumocfg").exists():
            return folder
        folder.mkdir(exist_ok=True)
        words = ("--grid", "--grid.number=2", "--grid.length=90", "--sidewalks.guess")
        lights = ("--crossings.guess", "--default-junction-type=traffic_light", "--seed=1")
        net = folder / "town.net.xml"
        program = Path(sumo.SUMO_HOME) / "bin" / "netgenerate"
        subprocess.run([program, *words, *lights, "-o", net], check=True, capture_output=True)
        text = re.sub(r"<!--.*?-->", "", net.read_text(encoding="utf-8"), flags=re.DOTALL)
        net.write_text(text, encoding="utf-8")  # without the day and the place of its making
        (folder / "town.rou.xml").write_text(DEMAND)
        (folder / "town.add.xml").write_text(ADDITIONAL)
        (folder / "town.sumocfg").write_text(TOWN)
        return folder

    @cached_property
    def settings(self) -> dict[str, str]:
        """Every setting of a run in each bundled scenario, as ``giveway config`` prints them.

        And people who come in, which no bundled scenario has.
        """
        return {name: self._said("config", name) for name in SCENARIOS} | {"crowds": CROWDS}

    @cached_property
    def studies(self) -> dict[str, str]:
        """Texts of study files."""
        return {"small": STUDY, "precise": STUDY + PRECISE, "levels": LEVELS}

    @cached_property
    def fmus(self) -> list[Path]:
        """The bundled vehicles, of FMI 2.0 and 3.0."""
        import fmus

        return [Path(fmus.__file__).parent / name for name in FMUS]

    @property
    def profile(self) -> str:
        """A profile of the bundled vehicles in which most keys are set."""
        return PROFILE

    @cached_property
    def clips(self) -> dict[str, bytes]:
        """Two clips, one of them with a vehicle, and the description of their data set."""
        time = np.arange(140) / _RATE
        starts = np.array([[-4.0, 1.6], [3.0, -2.0], [0.0, 4.0]])
        speeds = np.array([[1.0, 0.0], [-1.0, 0.3], [1.2, 0.1]])
        people = ["id,frame,label,x_est,y_est,vx_est,vy_est"]
        for number, (start, speed) in enumerate(zip(starts, speeds, strict=True), 1):
            for frame, (x, y) in enumerate(start + time[:, None] * speed, 101):
                place = f"{x:.3f},{y:.3f},{speed[0]:.3f},{speed[1]:.3f}"
                people.append(f"{number},{frame},ped,{place}")
        cart = ["id,frame,label,x_est,y_est,psi_est,vel_est"]
        cart += [f"1,{101 + k},veh,{0.5 * t:.3f},0.0,0.0,0.5" for k, t in enumerate(time)]
        walking, driving = ("\n".join(lines).encode() + b"\n" for lines in (people, cart))
        return {
            "front_interaction_01_traj_ped_filtered.csv": walking,
            "front_interaction_01_traj_veh_filtered.csv": driving,
            "unidirection_02_traj_ped_filtered.csv": walking,
            "mine.toml": DATASET.encode(),
        }

    @cached_property
    def presets(self) -> list[str]:
        """Texts of preset files: whole ones, and one on a base."""
        from giveway.config.files.presets import preset_text
        from pedestrian_model import SIM, TABLE2

        few = 'name = "few"\nbase = "TABLE2"\n[parameters]\nmass = 70\nbody_radius = 0.25\n'
        origin = {"fitted": ["mass"], "clips": 3}
        return [preset_text("mine", parameters, origin) for parameters in (SIM, TABLE2)] + [few]

    @cached_property
    def study(self) -> Path:
        """The folder of a finished study, made by this giveway, beside its file ``small.toml``."""
        from giveway.studies.identity import software_identity

        folder = self._folder / f"study-{software_identity()}"
        file = self._folder / "small.toml"
        if not folder.exists():
            file.write_text(STUDY)
            self._said("study", file, "--out", folder, "--no-report")
        return folder

    @cached_property
    def runs(self) -> list[Path]:
        """Results of runs, made by this giveway: with predictions, and with cars around."""
        from giveway.studies.identity import software_identity

        folder = self._folder / f"runs-{software_identity()}"
        predicted = ("shared_space", "--pedestrians", 3, "--record-predictions", 0.5)
        words = {"predicted": predicted, "street": ("street", "--pedestrians", 3)}
        for name, those in words.items():
            if not (folder / name).exists():
                short = ("--time-limit", 1, "--no-pictures", "--out", folder / name)
                self._said("run", *those, *short)
        return [folder / name for name in words]

    @cached_property
    def journal(self) -> Path:
        """The journal that a killed run has left, whose results were to go to ``r``."""
        from giveway.studies.identity import software_identity

        folder = self._folder / f"journal-{software_identity()}"
        if not folder.exists():
            folder.mkdir()
            results = self._folder / "journalled"
            shutil.rmtree(results, ignore_errors=True)
            made = [sys.executable, "-c", JOURNAL, folder, results]
            subprocess.run(made, check=True, capture_output=True, env=self._nursery.environment)
        return folder

    @cached_property
    def driven(self) -> Path:
        """Results of a run of ``car.fmu`` beside them, which is no bundled vehicle."""
        from giveway.studies.identity import software_identity

        folder = self._folder / f"driven-{software_identity()}" / "run"
        if not folder.exists():
            car = folder.with_name("car.fmu")
            car.parent.mkdir(exist_ok=True)
            with zipfile.ZipFile(self.fmus[0]) as ours, zipfile.ZipFile(car, "w") as theirs:
                for name in ours.namelist():
                    theirs.writestr(zipfile.ZipInfo(name), ours.read(name))
            short = ("--pedestrians", 2, "--time-limit", 0.5, "--no-pictures", "--out", folder)
            self._said("run", "--vehicle", car, *short)
        return folder

    @cached_property
    def kernels(self) -> Path:
        """A folder with a kernel cache, and the results of the run that has made it."""
        from giveway._kernels.cache import kernel_digest
        from giveway.studies.identity import software_identity

        folder = self._folder / f"kernels-{kernel_digest()}-{software_identity()}"
        if not (folder / "out" / "ego.csv").exists():
            folder.mkdir(exist_ok=True)
            words = (*KERNELS_RUN, "--out", "out", "--force")
            ended = self._nursery.type(words, folder, LIMIT, folder / "cache")
            if ended.code:
                raise RuntimeError(f"giveway {words[0]}: {ended.err}")
        return folder

    def _said(self, *words: object) -> str:
        (self._folder / "made").mkdir(exist_ok=True)
        ended: Ended = self._nursery.type(words, self._folder / "made", LIMIT)
        if ended.code:
            raise RuntimeError(f"giveway {words[0]}: {ended.err}")
        return ended.out
