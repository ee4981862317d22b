"""Reading of the bundled JSON tables in ``minecraft/data``."""

import gzip
import json
from importlib.resources import files
from typing import Any


def read_data(name: str) -> Any:
    """Return the value in a bundled JSON file, which is compressed if its name ends in ``.gz``."""
    data = files("world2minecraft.minecraft").joinpath(f"data/{name}").read_bytes()
    return json.loads(gzip.decompress(data) if name.endswith(".gz") else data)
