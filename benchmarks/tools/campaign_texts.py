"""The texts of files that the campaign mutates: studies, crowds, a profile, a town, a journal."""

from typing import Final

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
PRECISE: Final = """
[precision]
metric = "mean_speed"
width = 0.5
minimum = 10
batch = 2
"""
LEVELS: Final = """name = "levels"
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
CROWDS: Final = """scenario = "shared_space"
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
PROFILE: Final = """[fmu]
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
DATASET: Final = """name = "MINE"
frame_rate = 29.97
y_axis = "down"
[vehicle]
front = 1.0
rear = 1.2
width = 1.2
"""
TOWN: Final = """<configuration>
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
DEMAND: Final = """<routes>
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
ADDITIONAL: Final = """<additional>
    <busStop id="halt" lane="B0B1_1" startPos="30" endPos="50"/>
    <poly id="house" type="building" color="red" fill="1" shape="10,10 20,10 20,20 10,20"/>
    <inductionLoop id="loop" lane="A0A1_1" pos="20" freq="30" file="loop.xml"/>
    <rerouter id="away" edges="B1B0" pos="0,0"><interval begin="0" end="20">
        <destProbReroute id="A0A1"/></interval></rerouter>
</additional>
"""
JOURNAL: Final = """import json
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
