"""Properties of blocks by name pattern, from a hand-written data file."""

from fnmatch import translate
from functools import cache, lru_cache
from re import Pattern
from re import compile as compiled

from world2minecraft.minecraft.data_files import read_data


@cache
def block_rules() -> dict[str, Pattern[str]]:
    """Load the name pattern of each list in the bundled data file. The result is cached."""
    raw = read_data("block_rules.json")
    return {key: pattern_of(names) for key, names in raw.items() if isinstance(names, list)}


def pattern_of(names: list[str]) -> Pattern[str]:
    """Return a pattern that matches any of the names, in which ``*`` is a wildcard."""
    return compiled("|".join(translate(name) for name in names) or r"(?!)")


@lru_cache(maxsize=1 << 16)
def is_among(name: str, rule: str) -> bool:
    """Return whether a block's full name is in a list of the data file and is not an exception.

    The exceptions of the list ``logs``, for example, are in the list ``not_logs``.

    Raises:
        KeyError: If the file has no such list.
    """
    rules = block_rules()
    bare = name.partition(":")[2] or name
    exceptions = rules.get(f"not_{rule}")
    if exceptions is not None and exceptions.match(bare):
        return False
    return rules[rule].match(bare) is not None
