"""The plan of a risk: what its runs share, and the run that each vector makes."""

import hashlib
import json
from collections.abc import Collection, Generator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.config.files.layers import Layer, merge, results_of
from giveway.config.files.loading import load
from giveway.cosimulation.preflight import preflight
from giveway.errors import ConfigError
from giveway.metrics.impacts import IMPACTS
from giveway.results.inputs import scenario_inputs
from giveway.risk.definition import RiskDefinition
from giveway.risk.estimators import (
    LEAST_BUDGETS,
    Estimate,
    Sampler,
    SobolIndex,
    importance_sampling,
    monte_carlo,
    sobol_indices,
    subset_simulation,
)
from giveway.risk.events import MAIS3, Event, read_event
from giveway.risk.inputs import CROWD, SEED, RandomInputs, people_placed, read_inputs
from giveway.scenario_files.declared_ids import declares_people, declares_traffic
from giveway.studies.identity import (
    cell_digest,
    input_hashes,
    relevant_versions,
    software_identity,
)
from giveway.studies.record import RunRecord, Task
from sumo_scenarios import Scenario

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class RiskRun:
    """One run of a risk.

    Attributes:
        number: Number of the run, from 1, in the order in which the estimator asked for it.
        vector: Components of its random inputs.
        key: Key of its record.
    """

    number: int
    vector: Vector
    key: str

    @property
    def id(self) -> str:
        """The run's name within the risk."""
        return f"r{self.number}"


@dataclass(frozen=True)
class RiskPlan:
    """A risk whose scenario, settings and inputs fit each other.

    Attributes:
        definition: Definition of the risk.
        origin: File of the risk, for messages.
        event: Event whose probability is estimated.
        inputs: Random inputs of the runs.
        hashes: SHA-256 of each file that the runs read.
        digest: Hash of everything that the runs have in common.
        trusted: Code, as module:Class, that the risk may import.
    """

    definition: RiskDefinition
    origin: str
    event: Event
    inputs: RandomInputs
    hashes: dict[str, str]
    digest: str
    trusted: Collection[str] = ()

    def layer(self, vector: Vector) -> Layer:
        """Return the settings of the run that a vector (d,) makes."""
        values = _shared(self.definition)
        drawn = Layer(f"{self.origin}: [inputs]", self.inputs.settings(vector))
        return Layer(
            self.origin,
            merge([Layer(self.origin, values), drawn]),
            results=results_of(Path(self.origin)),
        )

    def config(self, vector: Vector) -> RunConfig:
        """Return the configuration of the run that a vector (d,) makes.

        Raises:
            GivewayError: the settings cannot be used.
        """
        return load([self.layer(vector)], self.trusted)[0]

    def runs(self, vectors: Vector, first: int) -> list[RiskRun]:
        """Return the runs of vectors (n, d), numbered from ``first``."""
        return [
            RiskRun(first + k, vector, _key(self.digest, vector))
            for k, vector in enumerate(vectors)
        ]

    def task(self, run: RiskRun) -> Task:
        """Return the task that a worker needs to make a run."""
        text = self.config(run.vector).as_json()
        made_by = software_identity(), relevant_versions()
        return Task(run.id, run.key, text, self.hashes, *made_by)

    def criticality(self, run: RiskRun, record: RunRecord) -> float:
        """Return the criticality of a run."""
        return self.event.criticality(
            record, self.definition.criticality, self.inputs.injury_draw(run.vector)
        )

    def sampler(self) -> Sampler:
        """Return the estimator at its beginning."""
        wanted, dimension = self.definition, self.inputs.dimension
        if wanted.method == "subset":
            noise = () if dimension == 1 else (SEED,)
            return subset_simulation(dimension, wanted.runs, wanted.seed, wanted.confidence, noise)
        if wanted.method == "importance":
            return importance_sampling(dimension, wanted.runs, wanted.seed, wanted.confidence)
        random = np.random.default_rng(wanted.seed)
        return monte_carlo(dimension, wanted.runs, random, wanted.confidence)


@dataclass(frozen=True)
class Findings:
    """The results of all runs of a risk.

    Attributes:
        estimate: Probability of the event.
        indices: Sobol indices of the criticality; empty if they were not wanted.
    """

    estimate: Estimate
    indices: tuple[SobolIndex, ...] = ()


Batches = Generator[list[RiskRun], list[RunRecord], Findings]
"""Batches of runs, which are sent their records in the same order."""


def batches(plan: RiskPlan) -> Batches:
    """Yield all batches of runs, and return the findings."""
    estimate: Estimate = yield from _asked(plan, plan.sampler(), 1)
    wanted = plan.definition
    if not wanted.why:
        return Findings(estimate)
    inputs = plan.inputs
    explaining = sobol_indices(
        inputs.dimension, inputs.groups, wanted.why, wanted.seed, wanted.confidence
    )
    return Findings(estimate, (yield from _asked(plan, explaining, 1 + estimate.runs)))


def _asked(
    plan: RiskPlan, vectors: Generator[NDArray[np.float64], NDArray[np.float64], Any], first: int
) -> Generator[list[RiskRun], list[RunRecord], Any]:
    """Yield batches of vectors as runs, numbered from ``first``, and return their result."""
    try:
        batch = next(vectors)
        while True:
            runs = plan.runs(batch, first)
            records = yield runs
            first += len(batch)
            batch = vectors.send(np.array(list(map(plan.criticality, runs, records))))
    except StopIteration as end:
        return end.value


def plan_risk(definition: RiskDefinition, origin: str, trusted: Collection[str] = ()) -> RiskPlan:
    """Check the scenario, the event and the random inputs of a risk.

    Args:
        definition: Definition of the risk.
        origin: File of the risk, for messages.
        trusted: Code, as module:Class, that the risk may import.

    Raises:
        GivewayError: the risk cannot be estimated; the message names the reason.
    """
    event = read_event(definition.event, origin)
    if definition.method != "monte-carlo" and not event.is_graded:
        raise ConfigError(
            f"{origin}: method = '{definition.method}' with event = '{event.name}': this event has "
            "no degrees that could guide the estimator; expected method = 'monte-carlo'"
        )
    least = LEAST_BUDGETS.get(definition.method, 0)
    if definition.runs < least:
        raise ConfigError(
            f"{origin}: runs = {definition.runs} with method = '{definition.method}': expected a "
            f"budget of at least {least}; with fewer runs use method = 'monte-carlo'"
        )
    scalars = read_inputs(definition.inputs, origin)
    layer = Layer(origin, _shared(definition), results=results_of(Path(origin)))
    config, scenario = load([layer], trusted)
    people = people_placed(config, definition.inputs.get(CROWD), origin)
    inputs = RandomInputs(scalars, people, event.name == MAIS3)
    _require_randomness(inputs, config, scenario, origin)
    hashes = input_hashes(config, scenario)
    common = cell_digest(config, hashes, software_identity())
    declared = json.dumps([definition.inputs, inputs.people], sort_keys=True)
    digest = hashlib.sha256(f"{common} {declared}".encode()).hexdigest()
    planned = RiskPlan(definition, origin, event, inputs, hashes, digest, trusted)
    preflight(planned.config(np.zeros(inputs.dimension)), scenario)
    return planned


def _shared(definition: RiskDefinition) -> dict[str, Any]:
    """Return the settings of all runs: those of the risk, and the metric that it needs."""
    added = Layer("risk", {"metrics": {IMPACTS: True}})
    return merge([Layer("risk", definition.settings), added])


def _require_randomness(
    inputs: RandomInputs, config: RunConfig, scenario: Scenario, origin: str
) -> None:
    """Make sure that two runs can differ.

    Raises:
        ConfigError: nothing is random.
    """
    files = scenario_inputs(scenario).values()
    by_seed = (
        config.crowd.adds_people
        or config.perception.position_noise > 0.0
        or isinstance(config.ego.depart_time, tuple)
        or (config.sumo.seed == "run" and (declares_traffic(files) or declares_people(files)))
    )
    if not inputs.scalars and not by_seed:
        raise ConfigError(
            f"{origin}: nothing is random: nobody is added, and no input is declared, so that all "
            'runs are the same; add people (crowd.pedestrians), or [inputs] like "vehicle.mass" = '
            "{ normal = [1000, 100] }"
        )


def _key(digest: str, vector: Vector) -> str:
    content = digest.encode() + np.ascontiguousarray(vector, dtype="<f8").tobytes()
    return hashlib.sha256(content).hexdigest()[:32]
