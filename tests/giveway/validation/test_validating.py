"""ADE, FDE and contacts, by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.validation import CITR, read_clips, validate
from pedestrian_model import SIM

if TYPE_CHECKING:
    import pandas as pd

DT = 1 / 29.97


def numbers(errors: pd.DataFrame, predictor: str, metric: str, subset: str = "all") -> list:
    rows = errors[(errors["predictor"] == predictor) & (errors["metric"] == metric)]
    return rows.loc[rows["subset"] == subset, "mean"].tolist()


def test_constant_velocity_is_exact_on_straight_tracks(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(180, [[0, 0], [3, 50]], [[1.2, 0.3], [-1.0, 0.0]])
    write_clip(tmp_path, "walk_01", x, v)
    errors = validate(read_clips(tmp_path, CITR), SIM).errors
    for predictor in ("CV", "goalCV"):
        for metric in ("ADE", "FDE"):
            assert numbers(errors, predictor, metric) == pytest.approx([0, 0, 0], abs=1e-9)


def test_a_velocity_that_is_wrong_by_so_much_gives_so_much_error(
    tmp_path, write_clip, straight_walks
) -> None:
    """0.1 m/s too fast: after h frames 0.1 h dt off, and on average 0.1 (h + 1)/2 dt."""
    x, v = straight_walks(180, [[0, 0]], [[1.0, 0.0]])
    write_clip(tmp_path, "walk_01", x, v + [0.1, 0.0])
    errors = validate(read_clips(tmp_path, CITR), SIM).errors
    h = np.array([22, 60, 120])
    assert numbers(errors, "CV", "FDE") == pytest.approx(0.1 * h * DT)
    assert numbers(errors, "CV", "ADE") == pytest.approx(0.1 * (h + 1) / 2 * DT)


@pytest.mark.parametrize(("speed", "counts"), [(0.6, True), (0.4, False)])
def test_near_is_who_meets_a_vehicle_that_moves(
    tmp_path, write_clip, straight_walks, speed, counts
) -> None:
    """The walker passes a cart 1 m beside it; the other stays 20 m away."""
    x, v = straight_walks(200, [[-4.0, 1.6], [-4.0, 20.0]], [[1.0, 0.0], [1.0, 0.0]])
    cart = np.zeros((200, 4))
    cart[:, 0], cart[:, 3] = speed * DT * np.arange(200), speed
    write_clip(tmp_path, "drive_01", x, v, cart)
    found = validate(read_clips(tmp_path, CITR), SIM)
    assert not found.found.near[1::2].any()
    assert found.found.near[::2].any() == counts
    near = found.errors.query("subset == 'near' and metric == 'FDE' and predictor == 'CV'")
    assert near["mean"].tolist() == pytest.approx(
        [0, 0, 0] if counts else [np.nan] * 3, abs=1e-9, nan_ok=True
    )
    assert (near["count"].min() > 0) == counts


def test_a_cart_hits_constant_velocity_walkers_not_the_model(
    tmp_path, write_clip, straight_walks
) -> None:
    """The data step aside and back; constant velocity, and the model without f_v, do not."""
    frames = 240
    x, v = straight_walks(frames, [[10.0, 0.3]], [[-0.8, 0.0]])
    x[:, 0, 1] += 1.6 * np.exp(-(((np.arange(frames) - 190) / 30) ** 2))
    cart = np.zeros((frames, 4))
    cart[:, 0], cart[:, 3] = -8.0 + 2.0 * DT * np.arange(frames), 2.0
    write_clip(tmp_path, "drive_01", x, v, cart)
    contacts = validate(read_clips(tmp_path, CITR), SIM).contacts.set_index("predictor")
    assert contacts["pedestrians"].tolist() == [1] * 5
    touching = contacts["touching"].to_dict()
    assert touching["CV"] == 1
    assert touching["VCI"] == touching["data"] == 0
    assert touching["VCI without f_v"] == 1
    assert contacts.loc["CV", "closest"] == pytest.approx(-SIM.body_radius)


def test_clips_without_a_vehicle_have_no_contacts_and_none_near(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(180, [[0, 0]], [[1, 0]])
    write_clip(tmp_path, "walk_01", x, v)
    found = validate(read_clips(tmp_path, CITR), SIM)
    assert found.contacts.empty
    assert found.errors.query("subset == 'near'")["count"].sum() == 0
