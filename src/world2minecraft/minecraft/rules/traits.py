"""What the rules of connection ask of a block state by itself, each as a small number.

A block is taken for a stair, a fence and so on by its name's end and by having the properties of
one, so mods' and newer games' blocks that keep to the game's names are joined as well.
"""

from functools import lru_cache
from typing import NamedTuple

from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.rules.name_patterns import is_among
from world2minecraft.minecraft.rules.supports import DIRECTIONS, faces_of

(OTHER, STAIRS, PANE, FENCE, BRICK_FENCE, GATE, WALL, DOOR, CHEST, LEAVES, SNOWY, CAMPFIRE,
 LOG, OLD_WALL) = range(14)  # fmt: skip
SIDES = DIRECTIONS[:4]
TYPES = ("single", "left", "right")
_ENDS = (  # The end of the name, the properties that it needs, and the kind.
    ("_stairs", ("facing", "half", "shape"), STAIRS),
    ("_pane", SIDES, PANE),
    ("_bars", SIDES, PANE),
    ("nether_brick_fence", SIDES, BRICK_FENCE),
    ("_fence", SIDES, FENCE),
    ("_fence_gate", ("facing", "in_wall"), GATE),
    ("_wall", (*SIDES, "up"), WALL),
    ("_door", ("facing", "half", "hinge", "open"), DOOR),
    ("chest", ("facing", "type"), CHEST),
    ("_leaves", ("distance",), LEAVES),
    ("", ("snowy",), SNOWY),
    ("campfire", ("signal_fire",), CAMPFIRE),
)


class Traits(NamedTuple):
    """Numbers that say all that a neighbour needs to know of a state."""

    kind: int = OTHER
    block: int = 0  # the same for states of one block
    facing: int = -1  # 0 north, 1 east, 2 south, 3 west
    top: int = 0  # a stair's half or a door's
    sturdy: int = 0  # bits by direction: a full face, of a block that is joined at all
    arms: int = 0  # bits: the lower face from its middle to the four sides; 16 for the middle
    post: int = 0  # raises the post of a wall under it
    up: int = 0  # a wall's own post
    variant: int = 0  # a chest's type; leaves' distance; 1 for snow and hay


@lru_cache(maxsize=1 << 16)
def traits_of(text: str) -> Traits:
    """Return the traits of a block state; ``block`` is 0 and is numbered by who compares blocks.

    Raises:
        UsageError: the text is no block state.
    """
    state = complete(parse_state(text))
    values = dict(state.properties)
    kind = _kind(state.name, values)
    if kind in (STAIRS, GATE, DOOR, CHEST) and values["facing"] not in SIDES:
        kind = OTHER
    faces = faces_of(str(state))
    joined = not is_among(state.name, "unjoinable")
    arms = sum(1 << side for side, held in enumerate(faces.down_arms) if held)
    return Traits(
        kind=kind,
        facing=SIDES.index(values["facing"]) if values.get("facing") in SIDES else -1,
        top=int(values.get("half") in ("top", "upper")),
        sturdy=sum(1 << way for way, held in enumerate(faces.full) if held and joined),
        arms=arms,
        post=int(is_among(state.name, "wall_posts")),
        up=int(kind == WALL and values.get("up") == "true"),
        variant=_variant(state.name, kind, values),
    )


def _kind(name: str, values: dict[str, str]) -> int:
    for end, needed, kind in _ENDS:
        if name.endswith(end) and all(key in values for key in needed):
            if kind == WALL and values["north"] in ("true", "false"):
                return OLD_WALL  # Of 1.15 and older: its sides are not low or tall.
            return kind
    return LOG if is_among(name, "logs") else OTHER


def _variant(name: str, kind: int, values: dict[str, str]) -> int:
    if kind == CHEST:
        return TYPES.index(values["type"]) if values["type"] in TYPES else 0
    if kind == OTHER:
        return int(is_among(name, "snow")) + 2 * (name == "minecraft:hay_block")
    return 0
