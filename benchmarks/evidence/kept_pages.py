"""The pages that are not made anew with the others: KEPT.

The campaign of each has over 1,000 drives, or its data are not in the repository.
"""

from __future__ import annotations

import paper_tables
import samples
from page import DRIVING, Block, Page, told

BEHAVIOUR = "tuning/behaviour_tables.py"

KEPT = (
    Page(
        "benchmark",
        "docs/benchmark.md",
        (
            told(
                "rivals",
                "evidence/rivals.py --out {out} --jobs {jobs}",
                "seeds 701 to 800",
                "--out {out} --runs 2",
            ),
        ),
        (*DRIVING, "giveway/studies/benchmark"),
        kept=True,
    ),
    Page(
        "front",
        "docs/cookbook.md",
        (
            told(
                "front",
                "evidence/rivals.py --out {out} --front",
                "seeds 701 to 800",
                "--out {out} --front",
            ),
        ),
        (*DRIVING, "giveway/studies/benchmark"),
        kept=True,
    ),
    Page(
        "paper",
        "docs/reproduction.md",
        (Block("table 2", samples.PAPER, paper_tables.table_2),),
        kept=True,
    ),
    Page(
        "readings",
        "docs/reproduction.md",
        (Block("readings", samples.READINGS, paper_tables.readings),),
        kept=True,
    ),
    Page(
        "foreign-law",
        "docs/law.md",
        (
            told(
                "foreign networks",
                "law/road_campaign.py {data} --drives 8 --brief --out {out} --jobs {jobs}",
                "8 drives in each",
                "{data} --drives 1 --window 60 --out {out}",
            ),
        ),
        kept=True,
        junctions=True,
    ),
    Page(
        "recorded-people",
        "docs/safety.md",
        (
            told(
                "recorded people",
                "bounds/worst_motion.py {data} --dataset citr dut",
                "within 5 m of a moving vehicle",
                "{data} --dataset citr dut",
            ),
            told(
                "by site",
                "bounds/worst_motion.py {data} --dataset citr dut --sites",
                "1,000 resamples of clips",
                "{data} --dataset citr dut --sites",
            ),
        ),
        ("benchmarks/bounds/worst_motion.py", "giveway/validation"),
        kept=True,
    ),
    Page(
        "robustness",
        "docs/controllers.md",
        (
            told(
                "robustness",
                "bounds/robustness.py --runs 140 --out {out} --jobs {jobs}",
                "seeds 801 to 940 of each scene",
                "--runs 1 --out {out}",
            ),
        ),
        (*DRIVING, "benchmarks/bounds/robustness.py"),
        kept=True,
    ),
    Page(
        "recorded-cars",
        "docs/recordings.md",
        tuple(
            told(
                f"recorded cars, {preset}",
                f"tools/in_place_of_recorded.py {{data}} --dataset dut --out {{out}} {people}",
                "the 16 cars of DUT's roundabout",
                f"{{data}} --dataset dut --out {{out}} --controllers idm {people}",
            )
            for preset, people in (
                ("SIM", "--set crowd.preset=SIM --set perception.preset=SIM"),
                ("MIXED", "--set crowd.preset=MIXED --set perception.preset=MIXED"),
            )
        ),
        (*DRIVING, "giveway/recordings", "benchmarks/tools/in_place_of_recorded.py"),
        kept=True,
    ),
    Page(
        "behaviour",
        "docs/validation.md",
        (
            told("near a cart", f"{BEHAVIOUR} {{data}}/citr --dataset citr", "CITR"),
            told("near cars", f"{BEHAVIOUR} {{data}}/dut --dataset dut", "DUT, roundabout"),
            told("corridors", f"{BEHAVIOUR} --corridors", "two minutes"),
            told("recorded corridors", f"{BEHAVIOUR} {{data}}/hermes --dataset hermes", "HERMES"),
            told(
                "recorded corridors, faster",
                f"{BEHAVIOUR} {{data}}/hermes --dataset hermes --speeds 1.48 0.19",
                "HERMES",
            ),
        ),
        ("pedestrian_model", "giveway/crowd", "giveway/validation", f"benchmarks/{BEHAVIOUR}"),
        kept=True,
    ),
)
