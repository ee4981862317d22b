"""Lines of JSON, the same bytes for the same values."""

import json
from typing import Any


def json_line(value: dict[str, Any]) -> str:
    """Return a value as one line of JSON, with its end."""
    return json.dumps(value, allow_nan=False, sort_keys=True) + "\n"
