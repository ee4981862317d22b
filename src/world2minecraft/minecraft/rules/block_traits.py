"""Facts about blocks by name patterns, from one data file written by hand."""

import json
from fnmatch import translate
from functools import cache, lru_cache
from importlib.resources import files
from re import Pattern
from re import compile as compiled

DATA_FILE = "data/block_rules.json"


@cache
def block_rules() -> dict[str, Pattern[str]]:
    """Read the shipped file, once: the pattern of each list of names."""
    raw = json.loads(files("world2minecraft.minecraft").joinpath(DATA_FILE).read_text("utf-8"))
    return {key: pattern_of(names) for key, names in raw.items() if isinstance(names, list)}


def pattern_of(names: list[str]) -> Pattern[str]:
    """Return the pattern that matches any of some names with ``*`` in them."""
    return compiled("|".join(translate(name) for name in names) or r"(?!)")


@lru_cache(maxsize=1 << 16)
def is_among(name: str, rule: str) -> bool:
    """Whether a block's full name is in one list of the file, and in none of its exceptions.

    The exceptions of ``logs`` stand in ``not_logs``, and so on.

    Raises:
        KeyError: the file has no such list.
    """
    rules = block_rules()
    bare = name.partition(":")[2] or name
    exceptions = rules.get(f"not_{rule}")
    if exceptions is not None and exceptions.match(bare):
        return False
    return rules[rule].match(bare) is not None
