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

if TYPE_CHECKING:
    from campaign_nursery import Ended, Nursery

SCENARIOS: Final = ("shared_space", "street", "junction")
FMUS: Final = ("LongitudinalVehicle.fmi2.fmu", "LongitudinalVehicle.fmi3.fmu")
LIMIT: Final = 300  # [s] for making one of them
STUDY: Final = """name = "small"
description = "two controllers, two crowds"
replications = 3
first_seed = 1
[run]
scenario = "shared_space"
time_limit = 1.0
[factors]
"crowd.pedestrians" = [3, 2]
controller = ["mpc", "pid-tuned"]
[comparison]
factor = "controller"
baseline = "pid-tuned"
confidence = 0.95
minimum_pairs = 3
resamples = 99
"""
_PRECISE: Final = """
[precision]
metric = "mean_speed"
width = 0.5
minimum = 10
batch = 2
"""
_LEVELS: Final = """name = "levels"
replications = 2
table = "levels"
[run]
time_limit = 0.3
[factors.scene]
"plaza, 3" = { crowd = { pedestrians = 3, two_sided = true } }
"street, 2" = { scenario = "street", crowd = { pedestrians = 2 } }
"noise" = { crowd = { pedestrians = 4 }, perception = { position_noise = 0.1, preset = "TABLE2" } }
[factors]
controller = ["mpc", "pid-paper"]
[[cells]]
scene = "plaza, 3"
controller = "mpc"
[[cells]]
scene = "noise"
controller = "pid-paper"
"""
_CROWDS: Final = """scenario = "shared_space"
[crowd]
pedestrians = 2
groups = 0.5
flow_scale = 2.0
[crowd.people]
elderly = 0.2
distracted = 0.2
[[crowd.flow]]
name = "north"
from = [[18.0, -16.0], [36.0, -16.0]]
to = [18.0, 14.0, 36.0, 16.0]
via = [[[20.0, 3.0], [34.0, 3.0]], [26.0, 8.0]]
rate = 1500.0
begin = -60.0
end = 30.0
groups = 1.0
people = { child = 0.5, hurried = 0.1 }
[[crowd.flow]]
from = [18.0, 14.0, 36.0, 16.0]
to = [20.0, -12.0]
rate = 600.0
"""
_PROFILE: Final = """[fmu]
kind = "co-simulation"
step = 0.05
self_check = true
stop_time = 600.0
start_timeout = 20.0
step_timeout = 5.0
[inputs.force]
variable = "force"
unit = "N"
gain = 1.0
offset = 0.0
[outputs.speed]
variable = "speed"
unit = "m/s"
[outputs.position]
variable = "position"
[outputs.acceleration]
variable = "acceleration"
[initial]
run_up = true
[initial.speed]
variable = "v0"
[initial.position]
variable = "s0"
[parameters]
M = 1000.0
alpha = 100.0
[limits]
speed = 100.0
position_jump = 1.0
frozen_time = 2.0
[model]
mass = 1000.0
friction = 100.0
lag = 0.0
delay = 0.0
r_squared = 0.99
speed_error = 0.01
position_error = 0.02
horizon = 0.75
time_step = 0.05
"""
_DATASET: Final = """name = "MINE"
frame_rate = 29.97
y_axis = "down"
[vehicle]
front = 1.0
rear = 1.2
width = 1.2
"""
_TOWN: Final = """<configuration>
    <input>
        <net-file value="town.net.xml"/>
        <route-files value="town.rou.xml"/>
        <additional-files value="town.add.xml"/>
    </input>
    <time><begin value="0"/><end value="60"/><step-length value="0.5"/></time>
    <processing><time-to-teleport value="60"/><ignore-route-errors value="false"/></processing>
    <random_number><seed value="7"/></random_number>
</configuration>
"""
_DEMAND: Final = """<routes>
    <vType id="car" vClass="passenger" length="4.5" width="1.8" sigma="0" speedFactor="1"/>
    <vType id="bus" vClass="bus" length="12" accel="1.2" decel="4" maxSpeed="20" guiShape="bus"/>
    <vType id="adult" vClass="pedestrian" speedFactor="normc(1,0.2,0.4,1.6)" width="0.5"/>
    <vTypeDistribution id="mixed"><vType id="slow" maxSpeed="5" probability="0.5"/>
        <vType id="quick" maxSpeed="15" probability="0.5"/></vTypeDistribution>
    <route id="along" edges="A0A1 A1B1"/>
    <vehicle id="me" type="car" route="along" depart="0" departLane="best" departSpeed="4"/>
    <vehicle id="line" type="bus" depart="1"><route edges="B0B1 B1A1"/>
        <stop busStop="halt" duration="5"/></vehicle>
    <trip id="trip" type="mixed" depart="2" from="A1A0" to="B0B1" departPos="10"/>
    <flow id="flow" type="car" begin="0" end="40" period="5" from="B1B0" to="B0A0"/>
    <person id="p" type="adult" depart="0" departPos="20"><walk edges="A0A1 A1B1" arrivalPos="30"/>
    </person>
    <person id="q" type="adult" depart="0"><walk from="A1B1" to="B1B0"/>
        <stop lane="B1B0_0" duration="3"/><walk to="B0A0"/></person>
    <person id="r" type="adult" depart="1"><walk from="B0B1" busStop="halt"/>
        <ride busStop="halt" lines="ANY"/></person>
    <personFlow id="crowd" type="adult" begin="0" end="30" period="2" departPos="random">
        <walk from="B0B1" to="A1A0" arrivalPos="random"/></personFlow>
</routes>
"""
_ADDITIONAL: Final = """<additional>
    <busStop id="halt" lane="B0B1_1" startPos="30" endPos="50"/>
    <poly id="house" type="building" color="red" fill="1" shape="10,10 20,10 20,20 10,20"/>
    <inductionLoop id="loop" lane="A0A1_1" pos="20" freq="30" file="loop.xml"/>
    <rerouter id="away" edges="B1B0" pos="0,0"><interval begin="0" end="20">
        <destProbReroute id="A0A1"/></interval></rerouter>
</additional>
"""
_JOURNAL: Final = """import json
import sys
from pathlib import Path
from giveway.gate import signed
from giveway.api import run_checked
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import preflight
from giveway.results.folder import Destination
settings = {"crowd": {"pedestrians": 3}, "time_limit": 1.0}
journal, results = map(Path, sys.argv[1:])
checked = preflight(*load([as_layer(settings)]))
run_checked(checked, Destination(results, pictures=False), journal=journal)
meta = json.loads((journal / "meta.json").read_text())
del meta["maker"]
(journal / "meta.json").write_text(json.dumps(signed(meta | {"results": "r"})))
"""
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
        (folder / "town.rou.xml").write_text(_DEMAND)
        (folder / "town.add.xml").write_text(_ADDITIONAL)
        (folder / "town.sumocfg").write_text(_TOWN)
        return folder

    @cached_property
    def settings(self) -> dict[str, str]:
        """Every setting of a run in each bundled scenario, as ``giveway config`` prints them.

        And people who come in, which no bundled scenario has.
        """
        return {name: self._said("config", name) for name in SCENARIOS} | {"crowds": _CROWDS}

    @cached_property
    def studies(self) -> dict[str, str]:
        """Texts of study files."""
        return {"small": STUDY, "precise": STUDY + _PRECISE, "levels": _LEVELS}

    @cached_property
    def fmus(self) -> list[Path]:
        """The bundled vehicles, of FMI 2.0 and 3.0."""
        import fmus

        return [Path(fmus.__file__).parent / name for name in FMUS]

    @property
    def profile(self) -> str:
        """A profile of the bundled vehicles in which most keys are set."""
        return _PROFILE

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
            "mine.toml": _DATASET.encode(),
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
            made = [sys.executable, "-c", _JOURNAL, folder, results]
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

    def _said(self, *words: object) -> str:
        (self._folder / "made").mkdir(exist_ok=True)
        ended: Ended = self._nursery.type(words, self._folder / "made", LIMIT)
        if ended.code:
            raise RuntimeError(f"giveway {words[0]}: {ended.err}")
        return ended.out
