"""JSON as giveway writes it: indented, without float noise, without NaN."""

import json
import math
from typing import Any, Final

DECIMALS: Final = 6
"""Decimals of every number: micrometres and microseconds, finer than any comparison."""


def json_text(content: dict[str, Any]) -> str:
    """Return the content as JSON, in which NaN and infinity become null."""
    return json.dumps(_ready(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _ready(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _ready(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_ready(item) for item in value]
    if isinstance(value, float):
        return round(value, DECIMALS) + 0.0 if math.isfinite(value) else None
    return value
