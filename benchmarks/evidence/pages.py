"""The pages with measured blocks: what is run for each, and which block it fills."""

from __future__ import annotations

import comparisons
import samples
from kept_pages import KEPT
from makers import (
    BELOW_TTC,
    BRIEF,
    CONTROLLER_COLUMNS,
    JERK,
    LAW_COLUMNS,
    LAYER,
    MODEL_COLUMNS,
    ROAD_COLUMNS,
    TIME,
    WAIT,
    code,
    drives_told,
    less,
    means,
    part,
)
from page import DRIVING, Block, Page, shell, told
from tables import FRONTAL, SIDE, Column
from work import Command

CLAIRVOYANT = tuple(
    f"benchmarks/bounds/clairvoyant{part}.py"
    for part in ("", "_encroachment", "_front", "_front_tables", "_lattice", "_search")
)


SIGHT = ("hidden_child", "school_run", "false_detections", "markdown_table")

SPEED = (
    shell("bench_loop.py", "bench_loop.py", "--pairs 1"),
    shell("bench_scenario.py", "bench_scenario.py", "--walkers 100 --window 1"),
    shell("bench_crowd.py", "bench_crowd.py"),
    shell("bench_crowd_threads.py", "bench_crowd_threads.py"),
    shell("bench_models.py", "bench_models.py", "--people 5 --steps 3"),
    shell("bench_qp.py", "bench_qp.py"),
    shell("bench_fmu.py", "bench_fmu.py", "--ticks 50 --rounds 1"),
    shell("bench_controller.py", "bench_controller.py"),
    shell(
        "bench_study.py",
        "bench_study.py --runs 60 --crowds 60 --memory 1000",
        "--runs 2 --crowds 2 --memory 10",
    ),
    shell("bench_start.py", "bench_start.py --cold", "--rounds 1"),
    shell("bench_metrics.py", "bench_metrics.py", "--repetitions 1"),
    shell("bench_sight.py", "bench_sight.py"),
    told("machine", "speed/performance.py --machine", "one machine", "--machine"),
)

PAGES: dict[str, Page] = {
    page.name: page
    for page in (
        Page(
            "cookbook", "docs/cookbook.md", (Block("encounter", samples.FIRST_DRIVES, drives_told),)
        ),
        Page(
            "controllers",
            "docs/controllers.md",
            (
                Block("styles", samples.ATTITUDES, means(*BRIEF)),
                Block("differences", samples.CONTROLLERS, comparisons.differences),
                Block("saved", samples.CONTROLLERS, comparisons.saved),
                Block("margins", samples.CONTROLLERS, comparisons.margins),
                Block("all scenes", samples.CONTROLLERS, means(*CONTROLLER_COLUMNS)),
                Block("on roads", samples.ON_ROADS, means(*ROAD_COLUMNS)),
                Block("on roads, differences", samples.ON_ROADS, comparisons.differences),
            ),
            junctions=True,
        ),
        Page(
            "ablation",
            "docs/ablation.md",
            (
                Block(
                    "variants",
                    samples.ABLATION,
                    means(
                        TIME,
                        WAIT,
                        JERK,
                        BELOW_TTC,
                        FRONTAL,
                        LAYER,
                        *less(TIME, WAIT, JERK, BELOW_TTC),
                    ),
                ),
            ),
        ),
        Page(
            "models",
            "docs/pedestrians.md",
            (
                Block("drivers", samples.MODELS, means(*MODEL_COLUMNS)),
                Block("beliefs", samples.BELIEFS, means(*MODEL_COLUMNS)),
            ),
        ),
        Page(
            "safety",
            "docs/safety.md",
            (
                Block(
                    "assumptions",
                    samples.ASSUMPTIONS,
                    means(
                        TIME,
                        *less(TIME),
                        WAIT,
                        BELOW_TTC,
                        LAYER,
                        FRONTAL,
                        Column("beyond_assumption", "beyond", 0, "sum"),
                        Column("contacts_beyond", "of these hit", 0, "sum"),
                    ),
                ),
                Block("noise", samples.NOISE, means(TIME, JERK, BELOW_TTC, LAYER, FRONTAL)),
                Block("layer", samples.LAYER, means(TIME, WAIT, JERK, FRONTAL, SIDE, LAYER)),
            ),
        ),
        Page(
            "bounds",
            "docs/bounds.md",
            (
                told(
                    "clairvoyant", "bounds/clairvoyant.py --seeds 60", "seeds 1 to 60", "--seeds 2"
                ),
                told(
                    "front",
                    "bounds/clairvoyant_front.py --seeds 30 --rows {out}.csv",
                    "seeds 551 to 580",
                    "--seeds 2 --rows {out}.csv",
                ),
            ),
            (*DRIVING, *CLAIRVOYANT),
        ),
        Page(
            "encounter",
            "docs/encounters.md",
            (told("densities", "bounds/encounters.py --seeds 40", "seeds 1 to 40", "--seeds 2"),),
            (*DRIVING, *CLAIRVOYANT, "benchmarks/bounds/encounters.py"),
        ),
        Page(
            "law",
            "docs/law.md",
            (
                Block("law", samples.LAW, means(*LAW_COLUMNS)),
                told(
                    "drawn networks",
                    "law/road_campaign.py --drawn 1-12 --drives 8 --brief "
                    "--out {out} --jobs {jobs}",
                    "12 networks, 8 drives each",
                    "--drawn 1 --drives 1 --out {out}",
                ),
                told(
                    "meeting roads",
                    "law/road_campaign.py --roads 1-3 --brief --out {out} --jobs {jobs}",
                    "seeds 1 to 3",
                    "--roads 1 --place ramp --out {out}",
                ),
            ),
            (*DRIVING, "benchmarks/law"),
            junctions=True,
        ),
        Page(
            "pid",
            "docs/pid.md",
            (
                Block(
                    "gains",
                    Command("tuning/tune_pid.py", "no drives"),
                    code("tuning/tune_pid.py"),
                ),
                Block(
                    "profiles",
                    samples.PROFILES,
                    means(
                        TIME,
                        WAIT,
                        JERK,
                        Column("share_below_safe_distance", "below d_safe", 3),
                        FRONTAL,
                    ),
                ),
            ),
            (*DRIVING, "benchmarks/tuning"),
        ),
        Page(
            "contrary-people",
            "docs/controllers.md",
            (told("contrary people", "bounds/contrary_people.py", "one drive each", ""),),
            (*DRIVING, "benchmarks/bounds/contrary_people.py"),
        ),
        Page(
            "creeping",
            "docs/ablation.md",
            (told("creeping", "bounds/endless_stream.py", "seeds 1 to 3", "--seeds 1"),),
            (*DRIVING, "benchmarks/bounds/endless_stream.py"),
        ),
        Page(
            "sight",
            "docs/sight.md",
            (
                told(
                    "hidden child",
                    "bounds/hidden_child.py --instants 16",
                    "16 instants",
                    "--instants 1",
                ),
                told("school", "bounds/school_run.py", "nine instants", "--instants 1"),
                told("false detections", "bounds/false_detections.py", "ten seeds", "--seeds 1"),
            ),
            (
                *DRIVING,
                *(f"benchmarks/bounds/{name}.py" for name in SIGHT),
            ),
        ),
        Page(
            "gym",
            "docs/gym.md",
            (told("policy", "evidence/gym_policy.py --seeds 20", "seeds 1 to 20", "--seeds 1"),),
            (*DRIVING, "giveway/gym", "benchmarks/evidence/gym_policy.py"),
        ),
        Page(
            "controller-fmu",
            "docs/controller_fmu.md",
            (
                told(
                    "same motion",
                    "evidence/controller_fmu_runs.py --runs 20",
                    "seeds 1 to 20",
                    "--runs 1",
                ),
            ),
            (*DRIVING, "benchmarks/evidence/controller_fmu_runs.py"),
        ),
        Page(
            "performance", "docs/performance.md", SPEED, (*DRIVING, "giveway", "benchmarks/speed")
        ),
        Page(
            "install",
            "docs/install.md",
            (
                Block("extras", Command("speed/install_cost.py", "one machine"), part(0)),
                Block("dependencies", Command("speed/install_cost.py", "one machine"), part(1)),
            ),
            ("pyproject.toml", "benchmarks/speed/install_cost.py"),
        ),
        Page(
            "notebooks",
            "docs/notebooks.md",
            (told("notebooks", "../docs/notebooks/execute.py", "seed 4; junction: seed 1"),),
            (*DRIVING, "giveway/cli", "docs/notebooks"),
        ),
        Page(
            "tutorials",
            "docs/evidence.md",
            (told("tutorials", "../docs/tutorials/run.py", "in an empty folder each"),),
            (*DRIVING, "giveway/cli", "giveway/scenario_builder", "docs/tutorials"),
        ),
        *KEPT,
    )
}
