"""A row of the benchmark in words: intervals where there are some, in either notation."""

from __future__ import annotations

from giveway.studies.benchmark import Notation, rivals, texts


def test_a_kept_row_in_the_terminal_and_on_a_page():
    kept = rivals()
    ours = kept[(kept["controller"] == "idm") & (kept["scene"] == "stream, 30")].iloc[0]
    share, moving, passes, *_, contacts, arrived = texts(ours)
    low, high = (100.0 * ours[f"close_pass_share_{end}"] for end in ("low", "high"))
    assert share == f"{100.0 * ours.close_pass_share:.1f} [{low:.1f}, {high:.1f}]"
    assert moving.endswith("]")
    assert [float(each) for each in passes.split("/")] == [
        round(ours[f"{kind}_passes"], 2) for kind in ("close", "tight", "narrow")
    ]
    assert arrived == f"{ours.arrived:.0f}/{ours.drives}"

    paged = texts(ours, Notation(", ", " of ", "-"))
    assert paged[-1] == f"{ours.arrived:.0f} of {ours.drives}"
    assert paged[-2] == contacts.replace("/", ", ")


def test_what_is_not_known_of_recorded_drivers_is_a_dash():
    recorded = rivals().iloc[-1]
    told = texts(recorded)
    assert told[0] == "3.9 [0.0, 9.1]"
    assert told[3] == "–"
    assert texts(recorded, Notation(missing="-"))[3] == "-"
    beside_counts = recorded.astype(object)
    beside_counts[["frontal_contacts", "side_contacts"]] = None  # as whole numbers beside others
    assert texts(beside_counts) == told
