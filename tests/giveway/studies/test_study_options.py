"""Options of a study: what contradicts itself is refused."""

from __future__ import annotations

import pytest

from giveway.errors import ConfigError
from giveway.studies.study import StudyOptions


def test_what_contradicts_itself_is_refused():
    with pytest.raises(ConfigError, match="--resume and --force"):
        StudyOptions(resume=True, force=True)
    with pytest.raises(ConfigError, match="--jobs and --cluster"):
        StudyOptions(jobs=2, cluster="local:2")
