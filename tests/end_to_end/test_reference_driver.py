"""The human driver for reference, by the door for controllers that are not built in."""

import giveway


def drive(scenario, seed, **options):
    run = {"scenario": scenario, "seed": seed, "controller": "idm", "controller_options": options}
    return giveway.run(run | {"crowd.preset": "SIM"}, pictures=False)


def test_it_lets_a_crowd_pass_and_drives_on():
    result = drive("encounter", 4)
    assert result.summary["ending"] == "completed"
    assert result.summary["frontal_contacts"] == 0
    assert "person" in set(result.ego.reason)


def test_it_keeps_to_the_law_of_the_road():
    result = drive("junction", 3)
    assert result.summary["ending"] == "completed"
    assert {"stop line", "free"} <= set(result.ego.reason)
    assert not result.ledger.violation.any()


def test_its_headway_is_an_option():
    hasty, patient = (drive("encounter", 4, margin=margin) for margin in (0.5, 3.0))
    assert hasty.summary["completion_time"] < patient.summary["completion_time"]
