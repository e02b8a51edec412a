"""What a user may write, checked by ``mypy --strict`` without any plugin; see ``.ci/run``."""

import giveway
from giveway import RunConfig, RunResult


def longest_wait(seed: int) -> float:
    """[s] of one drive."""
    settings = {"scenario": "shared_space", "crowd.pedestrians": 5, "seed": seed}
    result: RunResult = giveway.run(settings)
    return float(result.summary["longest_wait"])


def main() -> None:
    """Run, look, keep."""
    result = giveway.run(RunConfig(seed=4, controller="pid-tuned"), out="mine", force=True)
    result.plot("state").savefig("state.png")
    result.replay().save("replay.html")
    print(result, result.ego["time"].max(), longest_wait(3))  # noqa: T201


def compare() -> float:
    """Mean difference [s] of a small study."""
    study = giveway.study({"factors": {"controller": ["mpc", "pid-tuned"]}}, out="study")
    return float(study.comparison["mean_difference"].mean())
