"""What SUMO has printed, as it is told."""

from giveway.sumo.stderr import of_others

OURS = "Warning: Collision of person 'flow.1' and person 'flow.2', lane='gate_0', time=1.55.\n"
MIXED = "Warning: Collision of person 'flow.1' and person 'walker', lane='gate_0', time=1.60.\n"
OTHER = "Warning: Vehicle 'bus' performs emergency braking on lane 'a_0'.\n"


def test_sumos_collisions_among_people_we_move_are_not_reported():
    assert of_others(OTHER + OURS + MIXED, {"flow.1", "flow.2"}) == OTHER + MIXED
    assert of_others(OURS, set()) == OURS
    assert of_others("", {"flow.1"}) == ""


def test_people_we_move_may_appear_anywhere():
    appeared = "Warning: Person 'flow.1' suddenly appeared inside detector 'e2'. time=25.20.\n"
    assert of_others(appeared + OTHER, {"flow.1"}) == OTHER
    assert of_others(appeared, {"walker"}) == appeared
