"""The settings with which SUMO is started."""

from giveway.config import RunConfig


def test_outputs_and_options_reach_sumo() -> None:
    from giveway.cosimulation.assembly import start_options

    config = RunConfig.model_validate({"sumo": {"outputs": "fcd,ssm", "options": "--end 54012.35"}})
    started = start_options(config, True, None)
    assert started.written == ("fcd", "ssm")
    assert started.extra == ("--end", "54012.35")
