"""What a block state needs of its neighbours, and what a neighbour offers.

The rules stand in ``data/support_rules.json``, which says how they are written.
"""

import json
from functools import cache, lru_cache
from importlib.resources import files
from re import Pattern
from typing import Any, NamedTuple

from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.rules.light import lets_light_through
from world2minecraft.minecraft.rules.name_patterns import pattern_of
from world2minecraft.minecraft.rules.supports import (
    DIRECTIONS,
    DOWN,
    OPPOSITE,
    UP,
    faces_of,
    has_centre_below,
    is_solid,
)

DATA_FILE = "data/support_rules.json"
_AIR = ("minecraft:air", "minecraft:cave_air", "minecraft:void_air")
_WATER = ("water", "bubble_column", "seagrass", "tall_seagrass", "kelp", "kelp_plant")


class Wish(NamedTuple):
    """One way to be held: what is asked of the blocks in some directions, one of which must do.

    ``none`` turns it round: none of them may.
    """

    directions: tuple[int, ...]
    asked: str
    none: bool


class Demand(NamedTuple):
    """What a state needs: one of its wishes, else the reason holds."""

    wishes: tuple[Wish, ...]
    reason: str


class _Rule(NamedTuple):
    blocks: Pattern[str]
    unless: Pattern[str]
    when: dict[str, str]
    unless_values: dict[str, str]
    needs: tuple[str, ...]
    reason: str


@lru_cache(maxsize=1 << 16)
def needs_of(text: str) -> tuple[Demand, ...]:
    """Return all that a block state demands.

    Raises:
        UsageError: the text is no block state.
    """
    state = complete(parse_state(text))
    bare, values = state.name.partition(":")[2], dict(state.properties)
    if _names("never_asked").match(bare):
        return ()
    return tuple(
        Demand(tuple(_wish(need, state) for need in rule.needs if need != "never"), rule.reason)
        for rule in _rules()
        if rule.blocks.match(bare)
        and not rule.unless.match(bare)
        and all(values.get(key) == value for key, value in rule.when.items())
        and not any(values.get(key) == value for key, value in rule.unless_values.items())
    )


@lru_cache(maxsize=1 << 18)
def offers(text: str, asked: str, direction: int) -> bool:
    """Whether a block state gives what is asked of it.

    Args:
        text: the state.
        asked: a word of the rules, such as ``full`` or ``block:stone``.
        direction: where it lies, seen from the block that asks.

    Raises:
        UsageError: the text is no block state.
        KeyError: the rules know no such word.
    """
    state = complete(parse_state(text))
    word, _, rest = asked.partition(":")
    toward = OPPOSITE[direction]
    bare = state.name.partition(":")[2]
    faces = faces_of(text)
    if word in ("full", "rigid", "centre"):
        return getattr(faces, word)[toward]
    answers = {
        "any": lambda: state.name not in _AIR,
        "holds": lambda: not _names("replaceable").match(bare),
        "solid": lambda: is_solid(text),
        "loose": lambda: not is_solid(text),
        "rigid_top": lambda: faces.rigid[UP],
        "hangs": lambda: has_centre_below(state),
        "clear": lambda: lets_light_through(text),
        "wet": lambda: holds_water(text),
        "powers": lambda: _names("powers").match(bare),
        "block": lambda: _listed(rest).match(bare),
        "no": lambda: not _listed(rest).match(bare),
        "exact": lambda: _is_exactly(state, rest),
        "vine": lambda: bare == "vine" and state.get(rest) == "true",
    }
    return bool(answers[word]())


def holds_water(text: str) -> bool:
    """Whether a block state has water in it that would spread."""
    state = complete(parse_state(text))
    return state.name.partition(":")[2] in _WATER or state.get("waterlogged") == "true"


@lru_cache(maxsize=1 << 16)
def is_floodable(text: str) -> bool:
    """Whether spreading water would take the place of a block state."""
    state = complete(parse_state(text))
    if state.name in _AIR:
        return True
    if holds_water(text) or state.get("waterlogged"):
        return False
    return not (is_solid(text) or _names("unflooded").match(state.name.partition(":")[2]))


def _wish(need: str, state: BlockState) -> Wish:
    where, _, asked = need.partition(" ")
    where, dash, _ = where.partition("-")
    if asked.startswith("same:"):
        asked = f"exact:{state.name}:{asked.removeprefix('same:')}"
    return Wish(_directions(where, state), asked, bool(dash))


def _directions(where: str, state: BlockState) -> tuple[int, ...]:
    if where in ("ahead", "behind"):
        facing = state.get("facing")
        if facing not in DIRECTIONS:
            return ()
        way = DIRECTIONS.index(facing)
        return (way if where == "ahead" else OPPOSITE[way],)
    groups = {
        "around": tuple(range(6)),
        "beside": tuple(range(UP)),
        "above": (UP,),
        "below": (DOWN,),
    }
    return groups.get(where) or (DIRECTIONS.index(where),)


def _is_exactly(state: BlockState, wanted: str) -> bool:
    name, _, pair = wanted.rpartition(":")
    key, _, value = pair.partition("=")
    return state.name == name and state.get(key) == value


@cache
def _listed(names: str) -> Pattern[str]:
    """Return the pattern of a list of names, in which @dirt stands for a list of the file."""
    groups = _raw()["names"]
    flat: list[str] = []
    for name in names.split(","):
        flat += groups[name[1:]] if name.startswith("@") else [name]
    return pattern_of(flat)


@cache
def _names(key: str) -> Pattern[str]:
    return pattern_of(_raw()[key])


@cache
def _rules() -> tuple[_Rule, ...]:
    return tuple(
        _Rule(
            pattern_of(rule["blocks"]),
            pattern_of(rule.get("unless", [])),
            rule.get("when", {}),
            rule.get("unless_values", {}),
            tuple(rule["needs"]),
            rule["reason"],
        )
        for rule in _raw()["rules"]
    )


@cache
def _raw() -> dict[str, Any]:
    return json.loads(files("world2minecraft.minecraft").joinpath(DATA_FILE).read_text("utf-8"))
