"""Models for packs without model files: visible boxes with textures derived from block names.

Most resource packs only change the textures of the game's own models. Without the client jar, the
boxes of ``minecraft/visual_shapes.py`` get textures by block name: ``oak_stairs`` those of
``oak_planks``, a log its rings at the ends, a furnace its front. The game renders water and lava in
code; here they are boxes of the fluid's height, with a still texture above and a flowing one at the
sides.
"""

from collections.abc import Callable, Sequence

import numpy as np

from world2minecraft.minecraft.block_states import BlockState
from world2minecraft.minecraft.block_table import block_table
from world2minecraft.minecraft.versions import name_in_version, new_names
from world2minecraft.minecraft.visual_shapes import find_visual_family, visual_boxes
from world2minecraft.rendering.block_elements import (
    FACE_NAMES,
    BlockModel,
    Element,
    ElementFace,
    face_uv,
)
from world2minecraft.rendering.resource_packs.elements import (
    apply_quarter_turn,
    free_turn,
    quarter_turn,
)
from world2minecraft.rendering.resource_packs.tints import Tint
from world2minecraft.rendering.texture import Texture

FLUIDS = ("minecraft:water", "minecraft:lava")
FULL = 8 / 9  # The height of a source, blocks; each level below it is a ninth lower.
LAVA_LIGHT = 15
# A frame of the flowing texture is two blocks wide and high; the first quarter is one block.
_FLOW_SCALE = 0.5
# Endings of names that say a shape, and those of what it may be made of.
SHAPES = (
    *("stairs", "slab", "wall", "fence_gate", "fence", "button", "pressure_plate"),
    *("pane", "carpet"),
)
MADE_OF = ("", "s", "_planks", "_block", "_block_side")
OTHER_ENDINGS = {"_wood": "_log", "_hyphae": "_stem", "_carpet": "_wool", "_block": ""}
COVERS = ("waxed_", "infested_")  # Prefixes of blocks that look the same without them.
OTHER_NAMES = {
    "smooth_sandstone": "sandstone_top",
    "smooth_red_sandstone": "red_sandstone_top",
    "smooth_quartz": "quartz_block_bottom",
}
# Families of ``visual_boxes.json`` whose textures lie on their boxes as on a whole block.
BOXES = (
    *("fence", "fence gate", "wall", "carpet", "pressure plate", "button", "torch", "ladder"),
    *("cactus", "snow", "whole blocks that one sinks into"),
)
CROSSES = ("sapling", "flower", "tuft", "mushroom", "tall plant", "cobweb", "stalk")
FACINGS = {
    **{"up": (270, 0), "down": (90, 0)},
    **{"north": (0, 0), "east": (0, 90), "south": (0, 180), "west": (0, 270)},
}
AXES = {"x": (90, 90), "y": (0, 0), "z": (90, 0)}
Names = Callable[[str], str | None]  # A picture's name without its folder to the texture's, or None


def fluid_model(
    state: BlockState,
    texture_of: Callable[[str], Texture | None],
    tint: tuple[int, int, int] | None,
) -> BlockModel | None:
    """Return the model of water or lava, or None if the packs have no texture for it.

    Args:
        state: State with its ``level``: 0 for a source, 1 to 7 for decreasing height, 8 and more
            for falling fluid.
        texture_of: Function from a texture name to the packs' texture.
        tint: Colour of water. Lava has its own colour.
    """
    block = state.name.partition(":")[2]
    still, flow = (f"minecraft:block/{block}_{kind}" for kind in ("still", "flow"))
    if texture_of(still) is None:
        return None
    level = int(state.get("level", "0")) if state.get("level", "0").isdigit() else 0
    high = (1.0, 1.0 if level > 7 else FULL - level / 9, 1.0)  # What falls has more above it.
    is_lava = block == "lava"
    faces = tuple(
        _face(side, high, still, flow if texture_of(flow) else still, None if is_lava else tint)
        for side in range(6)
    )
    box = Element((0.0, 0.0, 0.0), high, faces, emission=LAVA_LIGHT if is_lava else 0)
    return BlockModel((box,), ambient_occlusion=not is_lava)


def _face(side: int, high: tuple[float, float, float], still: str, flow: str, tint: Tint):
    """Return a face: still above and below, flowing at the sides."""
    uv = face_uv(side, (0.0, 0.0, 0.0), high)
    flows = side not in (2, 3) and flow != still
    return ElementFace(flow if flows else still, uv * _FLOW_SCALE if flows else uv, tint)


def implied_model(
    state: BlockState,
    texture_of: Callable[[str], Texture | None],
    tint_of: Callable[[int], Tint],
    is_free: bool,
) -> BlockModel | None:
    """Return a model of a complete state from textures found by its name, or None.

    Args:
        state: State with all of its properties.
        texture_of: Function from a texture name to the packs' texture.
        tint_of: Function from a tint index to a colour, as for model files.
        is_free: Whether the model of an unknown block may be guessed as a cube, or as a cross if
            its texture has holes.
    """
    is_known = state.name in block_table().blocks
    if not (is_known or is_free):
        return None
    space, block = state.name.split(":")
    names = (block, *other_names(state.name))
    family = find_visual_family(state)

    def named(picture: str) -> str | None:
        name = f"{space}:block/{picture}"
        return name if texture_of(name) is not None else None

    if family is not None and family.name in CROSSES:
        return _cross(names, state, named, tint_of(0))
    if family is not None and family.name not in BOXES:
        return None
    stems = [stem for name in names for stem in _stems(name)]
    textures = next((found for stem in stems if (found := _sides(stem, state, named))), None)
    if textures is None:
        return None
    boxes = visual_boxes(str(state)).astype(float).tolist()
    is_guess = not is_known and boxes == [[0, 0, 0, 1, 1, 1]]
    if is_guess and _is_cut_out(texture_of(textures["north"])):
        return _cross(names, state, named, tint_of(0))
    return BlockModel(tuple(_box(box, textures, state, tint_of(0)) for box in boxes))


def _is_cut_out(texture: Texture | None) -> bool:
    return texture is not None and texture.has_holes and not texture.translucent


def other_names(name: str) -> list[str]:
    """Return the names of a block in older and newer game versions, without the namespace."""
    newest = name_in_version(name, 1 << 30)
    others = [newest, new_names().get(newest, newest)]
    return [other.partition(":")[2] for other in others if other != name]


def _stems(block: str) -> list[str]:
    """Return the beginnings of the picture names that a block may have, the likeliest first."""
    for cover in COVERS:
        block = block.removeprefix(cover)
    stems = [block]
    for shape in SHAPES:
        if block.endswith("_" + shape):
            base = block.removesuffix("_" + shape)
            stems += [base + ending for ending in MADE_OF]
            stems += [OTHER_NAMES[base]] if base in OTHER_NAMES else []
            break
    for ending, other in OTHER_ENDINGS.items():
        if block.endswith(ending):
            stems.append(block.removesuffix(ending) + other)
    return stems + [OTHER_NAMES[one] for one in (block,) if one in OTHER_NAMES]


def _sides(stem: str, state: BlockState, named: Names) -> dict[str, str] | None:
    """Return a texture for each side as the block stands to the north, or None."""

    def first(*endings: str) -> str | None:
        return next((found for one in endings if (found := named(stem + one))), None)

    half = {"upper": "_top", "lower": "_bottom"}.get(state.get("half"))
    if half is not None:  # A door: each half has one picture.
        one = first(half)
        return None if one is None else dict.fromkeys(FACE_NAMES, one)
    side = first("_side", "")
    if side is None:
        return None
    top = first("_top", "_end", "") or side
    if state.name.endswith(("_wood", "_hyphae")):
        top = side
    textures = dict.fromkeys(FACE_NAMES, side) | {"up": top, "down": first("_bottom") or top}
    front = first("_front_on", "_front") if state.get("lit") == "true" else first("_front")
    return textures | ({"north": front} if front else {})


def _box(box: list[float], textures: dict[str, str], state: BlockState, tint: Tint) -> Element:
    """Return a box with textures by place; a whole block is turned as its state says."""
    low, high = (box[0], box[1], box[2]), (box[3], box[4], box[5])
    top_only = state.name.endswith(("grass_block", "cauldron"))
    faces = tuple(
        ElementFace(
            textures[name],
            face_uv(side, low, high),
            tint if name == "up" or not top_only else None,
        )
        for side, name in enumerate(FACE_NAMES)
    )
    element = Element(low, high, faces)
    if (low, high) != ((0, 0, 0), (1, 1, 1)):
        return element
    turn = AXES.get(state.get("axis")) or FACINGS.get(state.get("facing"))
    return apply_quarter_turn(element, quarter_turn(*turn)) if turn else element


def _cross(names: Sequence[str], state: BlockState, named: Names, tint: Tint) -> BlockModel | None:
    """Return two crossed pictures of a plant, None where there is none of any of its names."""
    endings = [f"_stage{state.get('age')}", "", "_plant"]
    if state.get("half") in ("upper", "lower"):
        endings = ["_top" if state.get("half") == "upper" else "_bottom"]
    texture = next(
        (found for name in names for one in endings if (found := named(name + one))), None
    )
    if texture is None:
        return None
    low, high = (0.05, 0.0, 0.5), (0.95, 1.0, 0.5)
    faces: list[ElementFace | None] = [None] * 6
    for side in (4, 5):  # The whole picture, though the plane is a little narrower.
        faces[side] = ElementFace(texture, face_uv(side, low, high, (0, 0, 16, 16)), tint)
    turns = (free_turn((0, angle, 0), np.full(3, 0.5), rescale=True) for angle in (45.0, -45.0))
    planes = tuple(Element(low, high, tuple(faces), turn, shade=False) for turn in turns)
    return BlockModel(planes, ambient_occlusion=False)
