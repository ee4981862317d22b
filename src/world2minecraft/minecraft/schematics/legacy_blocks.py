"""The states of the numbers and data values that blocks had before 1.13."""

import json
import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from world2minecraft.minecraft.block_names import read_state
from world2minecraft.minecraft.block_states import complete, parse_state

FLATTENING = 1519  # 1.13: the table's states are named as that game names them.
_MOD_NAME = re.compile(r"[a-z0-9_.-]+:[a-z0-9_./-]+")


def legacy_state(number: int, value: int, names: Mapping[int, str]) -> tuple[str, bool]:
    """Return the state of a block number and data value, and whether vanilla games had it.

    Args:
        number: 0 to 4095.
        value: 0 to 15; one that its block did not use means the block's first.
        names: what the file itself calls its numbers; those of mods differ from file to file.

    Example:
        >>> legacy_state(5, 1, {})
        ('minecraft:spruce_planks', True)
        >>> legacy_state(900, 2, {900: "Shop:Shelf"}), legacy_state(901, 0, {})
        (('shop:shelf[data=2]', False), ('legacy:901_0', False))
    """
    states = _table().get(number)
    if states is not None:
        return states[value], True
    name = names.get(number, "").lower()
    if not _MOD_NAME.fullmatch(name) or name.startswith("minecraft:"):
        return f"legacy:{number}_{value}", False
    return (f"{name}[data={value}]" if value else name), False


@cache
def _table() -> dict[int, tuple[str, ...]]:
    text = files("world2minecraft.minecraft").joinpath("data/legacy_blocks.json").read_text("utf-8")
    return {int(key): _sixteen(states) for key, states in json.loads(text)["blocks"].items()}


def _sixteen(states: list[str | None]) -> tuple[str, ...]:
    first = next(state for state in states if state is not None)
    every = [state or first for state in states] + [first] * (16 - len(states))
    return tuple(_of_today(f"minecraft:{state}") for state in every)


def _of_today(text: str) -> str:
    state = parse_state(read_state(str(parse_state(text)), FLATTENING))
    if state.name.endswith("_stairs"):  # The table has the last of the shapes, not the first.
        state = state.having(shape="straight")
    if state.name.endswith("_trapdoor"):  # It has open ones as powered, which their value is not.
        state = state.having(powered="false")
    return str(complete(state))
