"""People who come in during a run, and the persons of SUMO that they become."""

import math
from collections.abc import Sequence

from giveway.config import RunConfig
from giveway.crowd.generation.sources import Sources
from giveway.errors import ConfigError
from giveway.sumo.session import SumoSession


class Arrivals:
    """Lets people of all sources come in, and adds them to SUMO.

    Args:
        sources: Sources of people in giveway's crowd.
        session: The running simulation.
        hosts: Edge that hosts the people of each flow and recording inside SUMO.
    """

    def __init__(self, sources: Sources, session: SumoSession, hosts: Sequence[str]) -> None:
        self.sources = sources
        self._session = session
        self._hosts = tuple(hosts)

    def update(self, step: int) -> None:
        """Let in the people who are due after a SUMO step, at the control step ``step``."""
        for names, host in zip(self.sources.enter(step), self._hosts, strict=True):
            if names:
                self._session.add_persons(names, host)


def require_end(config: RunConfig, end: float) -> None:
    """Make sure that a run without an ego ends though people keep coming.

    Args:
        config: Configuration of the run.
        end: End of the scenario [s], or infinity if it names none.

    Raises:
        ConfigError: the run would not end.
    """
    endless = [flow.name for flow in config.crowd.flow if flow.end is None]
    if config.ego.none and endless and end == math.inf and config.time_limit is None:
        raise ConfigError(
            f"flow '{endless[0]}': its people keep coming, no ego is to arrive and the scenario "
            "has no end: the run would not end; name an end of the flow [s], or --time-limit"
        )
