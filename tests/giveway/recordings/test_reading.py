"""Recordings of each format, from small files in the layouts that the data sets publish."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.errors import DatasetError
from giveway.recordings import KNOWN, dataset_of, read_recording, read_recordings

if TYPE_CHECKING:
    from pathlib import Path

SIND_PEOPLE = "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,ax,ay\n"
SIND_VEHICLES = (
    "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,yaw_rad,heading_rad,length,width,"
    "v_lon,v_lat,a_lon,a_lat,ax,ay\n"
)
IND = (
    "recordingId,trackId,frame,trackLifetime,xCenter,yCenter,heading,width,length,"
    "xVelocity,yVelocity\n"
)
WALKER = "pedestrian,0,0,1,0,0,0\n"
FCD_TOO_LATE = "<fcd-export>{}</fcd-export>".format(
    "".join(
        f'<timestep time="{time}"><person id="a" x="0" y="0" angle="0" speed="1"/></timestep>'
        for time in ("0.0", "0.1", "0.2", "1e308")
    )
)


@pytest.mark.parametrize("name", KNOWN)
def test_every_bundled_description_names_site_and_citation(name: str) -> None:
    dataset = dataset_of(name)
    assert dataset.site
    assert dataset.citation
    assert dataset.layout


def test_sind_keeps_its_bodies_and_names_its_traps(tmp_path: Path) -> None:
    people = "P0,0,-10.0,pedestrian,0,0,1,0,0,0\nP0,1,,pedestrian,0.1,0,1,0,0,0\n"
    riding = "".join(f"P1,{k},{k * 100},pedestrian,{k * 0.44},5,4.4,0,0,0\n" for k in range(25))
    car = "7,1,100,car,9,0,3,0,0.1,0.2,4.6,1.9,3,0,0,0,0,0\n"
    bike = "8,1,100,bicycle,9,3,3,0,0.1,0.2,1.6,0.6,3,0,0,0,0,0\n"
    (tmp_path / "Ped_smoothed_tracks.csv").write_text(SIND_PEOPLE + people + riding)
    (tmp_path / "Veh_smoothed_tracks.csv").write_text(SIND_VEHICLES + car + bike)
    lights = "RawFrameID,timestamp(ms),Traffic light 1\n1,0,0\n2,5,2\n"
    (tmp_path / "TrafficLight_7_1.csv").write_text(lights)
    (found,) = read_recordings(tmp_path, dataset_of("sind"))
    assert found.name == tmp_path.name
    assert found.vehicles.ids == ("7",)
    np.testing.assert_allclose(found.vehicles.body, [[2.3, 2.3, 1.9]])
    assert found.vehicles.heading.tolist() == [0.2]
    walking = found.walkers()
    assert walking.people.ids == ("P0",)
    said = {defect.kind: (defect.count, defect.example) for defect in walking.defects}
    assert said["time empty or below 0"][0] == 2
    assert said["other label"] == (1, "'bicycle', left out")
    assert said["lights"] == (1, "TrafficLight_7_1.csv: code 2; known are 0, 1, 3")
    assert said["rider among people"][0] == 1


def test_ind_takes_labels_rate_and_unknown_bodies_from_its_files(tmp_path: Path) -> None:
    rows = "1,0,10,0,1,2,90,1.8,4.2,0,3\n1,0,11,1,1,2.1,90,1.8,4.2,0,3\n"
    rows += "1,1,10,0,5,5,180,0,0,-1,0\n1,2,10,0,6,6,0,0.6,1.7,4,0\n"
    (tmp_path / "07_tracks.csv").write_text(IND + rows)
    meta = "recordingId,trackId,class\n1,0,car\n1,1,pedestrian\n1,2,bicycle\n"
    (tmp_path / "07_tracksMeta.csv").write_text(meta)
    (tmp_path / "07_recordingMeta.csv").write_text("recordingId,frameRate\n1,30\n")
    (found,) = read_recordings(tmp_path, dataset_of("ind"))
    assert (found.name, found.frame_rate, found.first_frame, found.frames) == ("07", 30.0, 10, 2)
    assert (found.people.ids, found.vehicles.ids) == (("1",), ("0",))
    assert found.vehicles.kinds == ("car",)
    np.testing.assert_allclose(found.vehicles.heading, np.pi / 2)
    np.testing.assert_allclose(found.vehicles.speed, 3.0)
    np.testing.assert_allclose(found.vehicles.body, [[2.1, 2.1, 1.8]])
    (tmp_path / "07_tracksMeta.csv").write_text("recordingId,trackId,class\n1,0,car\n")
    with pytest.raises(DatasetError, match=r"07_tracksMeta\.csv: trackId 1 is missing; expected"):
        read_recordings(tmp_path, dataset_of("ind"))


def test_imptc_reads_a_file_per_track_whose_time_is_absolute(tmp_path: Path) -> None:
    for folder, name, kind, begin in (
        ("vrus", "001", "Pedestrian", 0),
        ("vehicles", "9", "Car", 2),
    ):
        rows = {
            f"ts_{k}": {"ts": 1675246894000000 + 40000 * (k + begin), "coordinates": [k, 2.0, 0.1]}
            for k in range(4)
        }
        file = tmp_path / folder / name / "track.json"
        file.parent.mkdir(parents=True)
        file.write_text(json.dumps({"overview": {"class_name": kind}, "track_data": rows}))
    (found,) = read_recordings(tmp_path, dataset_of("imptc"))
    assert (found.people.ids, found.vehicles.ids) == (("1",), ("9",))
    assert found.people.frame.tolist() == [0, 1, 2, 3]
    assert found.vehicles.frame.tolist() == [2, 3, 4, 5]
    np.testing.assert_allclose(found.people.velocity, np.tile([25.0, 0.0], (4, 1)), atol=1e-9)


def test_deepscenario_is_read_from_parquet(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    import pandas as pd

    rows = {
        "frame_id": [0, 1, 0, 1],
        "track_id": [4, 4, 5, 5],
        "translation_x": [0.0, 0.1, 9.0, 9.0],
        "translation_y": [0.0, 0.0, 1.0, 1.0],
        "rotation_z": [0.0, 0.0, 1.0, 1.0],
        "dimension_x": [4.0, 4.0, 0.5, 0.5],
        "dimension_y": [1.7, 1.7, 0.5, 0.5],
        "category": ["Car", "Car", "Pedestrian", "Pedestrian"],
    }
    file = tmp_path / "annotations" / "rec1" / "annotations.parquet"
    file.parent.mkdir(parents=True)
    pd.DataFrame(rows).to_parquet(file)
    (found,) = read_recordings(tmp_path, dataset_of("deepscenario"))
    assert (found.name, found.people.ids, found.vehicles.ids) == ("rec1", ("5",), ("4",))
    np.testing.assert_allclose(found.vehicles.velocity[:, 0], 2.5)


def test_eth_counts_frames_in_steps_of_ten(tmp_path: Path) -> None:
    lines = [f"{1 + 10 * k}.0e0 2.0e0 {0.4 * k} 0.0 -1.5 1.0 0.0 0.0" for k in range(10)]
    (tmp_path / "obsmat.txt").write_text("\n".join(lines) + "\n")
    (found,) = read_recordings(tmp_path, dataset_of("eth_ucy"))
    assert (found.frame_rate, found.frames, found.people.ids) == (2.5, 10, ("2",))
    assert found.people.position[3].tolist() == pytest.approx([1.2, -1.5])


def test_hermes_is_in_centimetres_without_velocities(tmp_path: Path) -> None:
    lines = [f"3 {k + 20} {10 * k} 50.5 170" for k in range(10)]
    (tmp_path / "uo-180-180-120.txt").write_text("\n".join(lines) + "\n")
    (found,) = read_recordings(tmp_path, dataset_of("hermes"))
    np.testing.assert_allclose(found.people.velocity, np.tile([1.6, 0.0], (10, 1)), atol=1e-12)
    assert found.people.position[0].tolist() == [0.0, 0.505]


def test_sumos_fcd_turns_its_angles_and_knows_people_from_vehicles(tmp_path: Path) -> None:
    steps = "".join(
        f'<timestep time="{0.1 * k:.2f}"><vehicle id="v" x="{k}" y="2" angle="90" speed="1e10"/>'
        f'<person id="p" x="5" y="{0.1 * k}" angle="0" speed="1"/></timestep>'
        for k in range(10)
    )
    (tmp_path / "fcd.xml").write_text(f"<fcd-export>{steps}</fcd-export>")
    (found,) = read_recordings(tmp_path, dataset_of("sumo_fcd"))
    assert (found.people.ids, found.vehicles.ids, found.frames) == (("p",), ("v",), 10)
    np.testing.assert_allclose(found.vehicles.heading, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.people.velocity, np.tile([0.0, 1.0], (10, 1)), atol=1e-12)
    assert found.vehicles.body.tolist() == [[0.0, 5.0, 1.8]]


MINE = """
name = "MINE"
frame_rate = 10.0
y_axis = "up"
[vehicle]
front = 2.2
rear = 2.2
width = 1.8
[[tables]]
files = "{name}_mine.csv"
holds = "people"
columns = { id = "who", frame = "k", x = "x", y = "y" }
"""


def test_gaps_duplicates_and_ids_that_start_again_are_named(tmp_path: Path) -> None:
    description = tmp_path / "mine.toml"
    description.write_text(MINE)
    rows = ["who,k,x,y"]
    rows += [f"1,{k},{0.1 * k},0" for k in (0, 1, 4, 5)]  # a gap
    rows += ["1,5,9,9"]  # twice
    rows += [f"2,{k},0,{0.1 * k}" for k in (0, 1)]
    rows += [f"2,{k},0,{0.1 * k}" for k in (90, 91)]  # somebody else
    (tmp_path / "a_mine.csv").write_text("\n".join(rows) + "\n")
    (found,) = read_recordings(tmp_path, dataset_of(str(description)))
    assert found.people.ids == ("1", "2", "2#2")
    assert {defect.kind: defect.count for defect in found.defects} == {
        "duplicate row": 1,
        "gap in a track": 1,
        "id starts again": 1,
    }
    assert "line 6: id 1 is in frame 5 twice" in found.defects[0].example
    np.testing.assert_allclose(found.people.position[3], [0.5, 0.0])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('frame = "k", ', "", "{name}_mine.csv: columns have neither frame nor time; give one"),
        ('id = "who", ', "", "{name}_mine.csv: columns.id is missing; give it"),
        ('x = "x", ', "", "tables.0.columns.x is missing; expected a text (place x)"),
        ('"people"', '"dogs"', "tables.0.holds = 'dogs': should be 'people', 'vehicles' or 'both'"),
        ('holds = "people"', "", "{name}_mine.csv: holds both, without a label"),
        ("files =", "file =", "tables.0.files is missing; expected a text (pattern"),
    ],
)
def test_a_wrong_description_names_its_key(tmp_path: Path, old: str, new: str, said: str) -> None:
    from giveway.errors import ConfigError

    description = tmp_path / "mine.toml"
    description.write_text(MINE.replace(old, new))
    with pytest.raises(ConfigError) as error:
        dataset_of(str(description))
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "file", "text", "said"),
    [
        ("imptc", "vrus/1/track.json", "{", "cannot be read as JSON"),
        ("imptc", "vrus/1/track.json", "{}", "key 'track_data' is missing"),
        ("sumo_fcd", "a.xml", "<a>", "cannot be read as XML"),
        ("hermes", "a.txt", "1 2 3 4 5 6\n", "cannot be read as text in columns"),
        ("hermes", "a.txt", "1 2 x 4 5\n", "line 1: x = 'x': expected a finite number"),
        ("sumo_fcd", "a.xml", "<a><b/></a>", "column 'id' is missing"),
        ("hermes", "a.txt", "1 inf 0 0 0\n", "line 1: frame = 'inf': expected a whole number"),
        (
            "hermes",
            "a.txt",
            "1 1 0 0 0\n-1e400 1 0 0 0\n",
            "line 2: id = '-1e400': expected a word",
        ),
        (
            "sind",
            "Ped_smoothed_tracks.csv",
            f"{SIND_PEOPLE}P0,,0,{WALKER}",
            "line 2: frame_id = ''",
        ),
        ("sind", "Ped_smoothed_tracks.csv", f"{SIND_PEOPLE},1,0,{WALKER}", "line 2: track_id = ''"),
        ("sumo_fcd", "a.xml", FCD_TOO_LATE, "row 4: time = '1e+308': expected a time within"),
    ],
)
def test_a_file_that_cannot_be_read_is_named(
    tmp_path: Path, name: str, file: str, text: str, said: str
) -> None:
    path = tmp_path / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    with pytest.raises(DatasetError) as error:
        read_recordings(tmp_path, dataset_of(name))
    assert str(path) in str(error.value)
    assert said in str(error.value)


def test_ids_that_no_integer_can_hold_are_words(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("1e300 1 0 0 0\n1e300 2 0 0 0\n")
    (found,) = read_recordings(tmp_path, dataset_of("hermes"))
    assert found.people.ids == ("1e300",)


def test_a_file_leads_to_its_recording(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.txt").write_text("1 1 0 0 0\n")
    assert read_recording(tmp_path / "b.txt", dataset_of("hermes")).name == "b"
    with pytest.raises(DatasetError, match=r"c\.txt: no such file of tracks; expected \*\.txt"):
        read_recording(tmp_path / "c.txt", dataset_of("hermes"))
