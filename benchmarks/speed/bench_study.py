"""What the runs of a study cost: the pool against a plain loop, two workers, Dask, memory.

Run: python benchmarks/speed/bench_study.py [--runs N] [--crowds N] [--cluster] [--memory N]

A run is the paper's: 30 pedestrians, MPC. Loop, one worker and two are timed in turn, in blocks of
ten runs, in one session; the ratios are what counts. ``--crowds`` makes runs of ``giveway study
paper``, 30, 20 and 10 people, by each controller in turn and by the processor's time, which others
on the machine hardly change.
"""

from __future__ import annotations

import argparse
import statistics
from dataclasses import asdict
from time import perf_counter, process_time
from typing import TYPE_CHECKING

from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.studies.execution import cluster_executor, local_executor
from giveway.studies.execution.perform import perform
from giveway.studies.identity import software_identity
from giveway.studies.record import RunRecord, Task

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from giveway.studies.execution import Executor

BLOCK = 10


def task(seed: int, controller: str = "mpc-paper", people: int = 30) -> Task:
    settings = {"seed": seed, "controller": controller, "crowd": {"pedestrians": people}}
    config, _ = load([Layer("", settings)])
    return Task(f"c1-s{seed}", f"{seed:032x}", config.model_dump_json(), {}, software_identity())


def numbers(records: Iterable[RunRecord]) -> dict[str, str]:
    """All that must not depend on who made the run."""
    return {r.run: repr({**asdict(r), "computing": None}) for r in records}


def timed(executor: Executor, tasks: Sequence[Task]) -> tuple[float, list[RunRecord]]:
    """Seconds per run, its workers being warm."""
    began = perf_counter()
    records = list(executor.run(tasks))
    return (perf_counter() - began) / len(tasks), records


def compare(tasks: Sequence[Task]) -> None:
    """Loop, pool of one, pool of two, block by block."""
    loop, one, two, overhead = [], [], [], []
    with local_executor(jobs=1) as single, local_executor(jobs=2) as double:
        plain = numbers(map(perform, tasks[:BLOCK]))  # warms this process
        assert numbers(timed(single, tasks[:BLOCK])[1]) == plain
        assert numbers(timed(double, tasks[:BLOCK])[1]) == plain
        for start in range(0, len(tasks), BLOCK):
            block = tasks[start : start + BLOCK]
            began = perf_counter()
            for each in block:
                perform(each)
            loop.append((perf_counter() - began) / len(block))
            seconds, records = timed(single, block)
            one.append(seconds)
            inside = statistics.mean(r.computing.seconds for r in records)
            overhead.append(seconds - inside)
            two.append(timed(double, block)[0])
    print(f"{len(tasks)} runs, in blocks of {BLOCK}: medians of seconds per run and of ratios")
    print(f"  plain loop:   {statistics.median(loop):.4f} s")
    print(f"  one worker:   {statistics.median(one):.4f} s, {_ratio(one, loop):.2f} of the loop")
    print(f"    of that the pool: {1e3 * statistics.median(overhead):.2f} ms")
    print(f"  two workers:  {statistics.median(two):.4f} s, {_ratio(two, loop):.2f} of the loop")
    print(f"  parallel efficiency of two: {_ratio(one, two) / 2:.2f}")


def cluster(tasks: Sequence[Task]) -> None:
    """Two Dask workers against two of our own."""
    with local_executor(jobs=2) as ours, cluster_executor("local:2") as dask:
        timed(ours, tasks[:BLOCK])
        timed(dask, tasks[:BLOCK])
        plain, records = timed(ours, tasks)
        seconds, theirs = timed(dask, tasks)
    print(f"  Dask local:2: {seconds:.4f} s, {seconds / plain:.2f} of two workers")
    print(f"  the same records: {numbers(records) == numbers(theirs)}")


def crowds(count: int) -> None:
    """What a crowd costs by each controller: the paper's two, and the default."""
    spent: dict[str, list[float]] = {name: [] for name in ("mpc-paper", "pid-paper", "mpc")}
    for seed in range(-2, count):
        for name, times in spent.items():
            each = task(max(seed, 0) + 1, name, (30, 20, 10)[seed % 3])
            began = process_time()
            perform(each)
            if seed >= 0:  # the first ones load kernels and fill caches
                times.append(process_time() - began)
    paper = sum(spent["mpc-paper"]) + sum(spent["pid-paper"])
    print(f"{count} crowds of 30, 20 and 10 people, processor time")
    for name, times in spent.items():
        print(f"  {name:10} {1e3 * sum(times) / count:6.1f} ms a run")
    print(f"  study paper: {2 * count / paper:.1f} runs per second of one processor")
    for name in ("mpc-paper", "pid-paper"):
        print(f"  mpc over {name}: {sum(spent['mpc']) / sum(spent[name]):.2f}")


def memory(runs: int) -> None:
    """What one worker holds after its first run, and after the last."""
    with local_executor(jobs=1) as executor:
        held = [r.computing.memory for r in executor.run(map(task, range(1, runs + 1)))]
    marks = sorted({1, min(200, runs), *(runs * n // 4 for n in range(1, 5))} - {0})
    print("  one worker holds [MB] after run " + ", ".join(f"{n}: {held[n - 1]}" for n in marks))
    print(f"  growth from run 1 to {runs}: {held[-1] - held[0]:.1f} MB")
    if runs > 200:
        print(f"  from run 200 to {runs}: {held[-1] - held[199]:.1f} MB")


def _ratio(above: Sequence[float], below: Sequence[float]) -> float:
    return statistics.median(a / b for a, b in zip(above, below, strict=True))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100, help="of each way")
    parser.add_argument("--crowds", type=int, default=0, metavar="RUNS", help="by each controller")
    parser.add_argument("--cluster", action="store_true", help="Dask, too")
    parser.add_argument("--memory", type=int, default=0, metavar="RUNS", help="in one worker")
    options = parser.parse_args()
    tasks = [task(seed) for seed in range(1, options.runs + 1)]
    compare(tasks)
    if options.crowds:
        crowds(options.crowds)
    if options.cluster:
        cluster(tasks)
    if options.memory:
        memory(options.memory)


if __name__ == "__main__":
    main()
