"""The models of giveway's crowd: built from the configuration."""

from __future__ import annotations

from giveway.config import RunConfig
from giveway.crowd.models import model_of
from giveway.crowd.motion.attention import Inattentive
from giveway.crowd.motion.cohesion import Cohesive
from giveway.crowd.roster import Roster

STEP = 0.05


def test_models_have_what_their_people_need_and_nothing_else() -> None:
    def of(**crowd) -> list[str]:
        config = RunConfig.model_validate({"crowd": crowd})
        model, names = model_of(config, STEP, Roster()), []
        while True:
            names.append(type(model).__name__)
            if not isinstance(model, Inattentive | Cohesive):
                return names
            model = model._model

    assert of() == ["CrowdModel"]
    assert of(people={"elderly": 1.0}) == ["CrowdModel"]
    assert of(groups=0.5) == ["Cohesive", "CrowdModel"]
    assert of(groups=0.5, model="orca") == ["PlainModel"]
    assert of(people={"distracted": 0.1}, model="orca") == ["Inattentive", "PlainModel"]
    flow = {"from": [0, 0, 1, 1], "to": [5, 5], "rate": 1.0, "groups": 0.5}
    assert of(flow=[{**flow, "people": {"distracted": 1.0}}]) == [
        "Cohesive",
        "Inattentive",
        "CrowdModel",
    ]
