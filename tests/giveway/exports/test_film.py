"""Films: as many frames as there are instants, and everybody where they were."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from giveway.exports.film import GIF_SIZE, MP4_SIZE, Painter, write_gif, write_mp4
from giveway.exports.sampling import sampled

VERMILION, BLUE = np.array([213, 94, 0]), np.array([0, 114, 178])


@pytest.fixture
def short(run):
    rows = run.trajectories
    early = rows[rows["time"] <= rows["time"].min() + 1.0]
    return type(run)(**{**run.__dict__, "trajectories": early})


def places(run, index, size):
    """Pixels (x, y) of the people and of the ego's middle, of those well inside the frame."""
    samples = sampled(run, 0.1)
    painter = Painter(run, samples, size)
    view = painter._view(index)
    found = {"people": [], "ego": []}
    for track in samples.tracks:
        k = index - track.first
        if not 0 <= k < len(track) or track.type not in {"pedestrian", "ego"}:
            continue
        x, y = track.x[k], track.y[k]
        if track.type == "ego":
            x, y = x - 3.5 * np.sin(np.deg2rad(track.angle[k])), y
        across = (x - view.left) / view.size[0] * size[0]
        down = (view.top - y) / view.size[1] * size[1]
        if 5 < across < size[0] - 5 and 60 < down < size[1] - 60:
            found["ego" if track.type == "ego" else "people"].append((int(across), int(down)))
    return found


def near(picture, place, colour):
    return np.abs(picture[place[1], place[0]].astype(int) - colour).max()


def test_a_gif_has_a_frame_for_each_instant_and_shows_everybody(short, tmp_path):
    file = tmp_path / "run.gif"
    samples = sampled(short, 0.1)
    write_gif(short, samples, file)
    with Image.open(file) as film:
        assert film.size == GIF_SIZE
        assert film.n_frames == samples.count == 11
        assert film.info["duration"] == 100
        assert film.info["loop"] == 0
        film.seek(7)
        picture = np.array(film.convert("RGB"))
    shown = places(short, 7, GIF_SIZE)
    assert len(shown["people"]) > 2
    assert near(picture, shown["ego"][0], BLUE) < 40
    hits = [near(picture, place, VERMILION) < 90 for place in shown["people"]]
    assert np.mean(hits) > 0.6  # some are hidden by others, or are a few pixels only


def test_an_mp4_is_read_back(short, tmp_path):
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")
    file = tmp_path / "run.mp4"
    samples = sampled(short, 0.1)
    write_mp4(short, samples, file)
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(file))
    assert frames == samples.count
    assert seconds == pytest.approx(1.1, abs=0.11)
    reader = imageio_ffmpeg.read_frames(str(file))
    about = next(reader)
    assert about["size"] == MP4_SIZE
    assert about["codec"] == "h264"
    shape = (MP4_SIZE[1], MP4_SIZE[0], 3)
    picture = [np.frombuffer(frame, np.uint8).reshape(shape) for frame in reader][7]
    shown = places(short, 7, MP4_SIZE)
    assert near(picture, shown["ego"][0], BLUE) < 40
    assert np.mean([near(picture, place, VERMILION) < 60 for place in shown["people"]]) > 0.8


def test_the_same_run_is_the_same_film(short):
    first, second = (
        [frame.tobytes() for frame in Painter(short, sampled(short, 0.5), GIF_SIZE).frames()]
        for _ in range(2)
    )
    assert first == second
    assert len(set(first)) == len(first)  # something moves
