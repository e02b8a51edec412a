"""JSON as giveway writes it: indented, without float noise, without NaN."""

import json
import math
from typing import Any, Final

DECIMALS: Final = 6
"""Of every number: micrometres, microseconds, finer than anything that is compared."""


def json_text(content: dict[str, Any]) -> str:
    """The content as JSON, which has neither NaN nor infinity: they become null."""
    return json.dumps(_ready(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _ready(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _ready(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_ready(item) for item in value]
    if isinstance(value, float):
        return round(value, DECIMALS) + 0.0 if math.isfinite(value) else None
    return value
