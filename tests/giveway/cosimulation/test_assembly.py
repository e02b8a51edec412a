"""What is assembled for a run."""

from giveway.config import RunConfig


def test_a_long_clock_keeps_its_fractions_on_the_way_to_sumo() -> None:
    from giveway.cosimulation.assembly import _start_options

    config = RunConfig.model_validate({"sumo": {"end": 54012.35}})
    assert _start_options(config, True, None).extra == ("--end", "54012.350")
