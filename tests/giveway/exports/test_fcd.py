"""SUMO's replay device drives what is written again, place by place."""

from __future__ import annotations

import json
import subprocess
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pandas as pd
from scipy.spatial import KDTree

from giveway.exports.fcd import write_fcd
from giveway.exports.net import Net
from giveway.exports.sampling import sampled

AT_END = 0.1  # [m] SUMO puts somebody who is closer than this to a lane's end onto it
ROUNDED = 1e-4  # [m] exactness of written coordinates

PROGRAM = """
import json, sys
import libsumo
libsumo.start(["sumo", "-c", sys.argv[1], "--no-step-log"])
seen = []
while libsumo.simulation.getTime() < libsumo.simulation.getEndTime():
    libsumo.simulationStep()
    time = round(libsumo.simulation.getTime(), 3)
    for domain in (libsumo.person, libsumo.vehicle):
        seen += [(time, name, *domain.getPosition(name)) for name in domain.getIDList()]
libsumo.close()
json.dump(seen, open(sys.argv[2], "w"))
"""


def test_a_replay_in_sumo_is_the_run(run, tmp_path):
    file = tmp_path / "run.fcd.xml"
    samples = sampled(run)
    told = write_fcd(run, samples, file)
    assert told.endswith("sumo-gui -c run.sumocfg")
    seen_file = tmp_path / "seen.json"
    words = [sys.executable, "-c", PROGRAM, str(tmp_path / "run.sumocfg"), str(seen_file)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
    read = json.loads(seen_file.read_text(encoding="utf-8"))
    seen = pd.DataFrame(read, columns=["time", "id", "x", "y"])
    rows = run.trajectories
    rows = rows.assign(time=(rows["time"] + samples.step).round(3))  # moved with SUMO's next step
    begun = rows.groupby("id")["time"].transform("min")
    rows = rows[rows["time"] > begun]  # SUMO itself puts everybody onto a lane first
    both = rows.merge(seen, on=["time", "id"])
    assert len(both) > 0.98 * len(rows)
    off = np.hypot(both["x_x"] - both["x_y"], both["y_x"] - both["y_y"])
    at_end = distance_to_lane_ends(Net.of(run).file, both[["x_x", "y_x"]]) < AT_END
    assert off[~at_end].max() < ROUNDED
    assert off.max() < AT_END
    assert at_end.sum() < 0.01 * len(both)


def distance_to_lane_ends(net, places):
    """Distance [m] of each place to the nearest end of a lane."""
    lanes = [lane.get("shape").split() for lane in ET.parse(net).getroot().iter("lane")]
    ends = [point.split(",")[:2] for lane in lanes for point in (lane[0], lane[-1])]
    return KDTree(np.array(ends, dtype=float)).query(places.to_numpy())[0]


def test_no_edge_is_inside_a_junction_and_types_are_declared(run, tmp_path):
    file = tmp_path / "run.fcd.xml"
    write_fcd(run, sampled(run), file)
    kinds = {kind.get("id") for kind in ET.parse(tmp_path / "run.types.add.xml").getroot()}
    steps = ET.parse(file).getroot().findall("timestep")
    assert len(steps) == sampled(run).count
    people = vehicles = 0
    for element in (element for step in steps for element in step):
        assert element.get("type") in kinds
        where = element.get("edge") if element.tag == "person" else element.get("lane")
        assert where
        assert not where.startswith(":")
        people += element.tag == "person"
        vehicles += element.tag == "vehicle"
    assert people > 1000
    assert vehicles > 400
