"""Water and lava, which the game draws in code: a box as high as the level, with a pack's textures.

A still one shows its still texture above; what flows shows the flowing one at its sides.
"""

from collections.abc import Callable

from world2minecraft.minecraft.block_states import BlockState
from world2minecraft.rendering.block_elements import BlockModel, Element, FaceLook, face_uv
from world2minecraft.rendering.resource_packs.tints import Tint
from world2minecraft.rendering.texture import Texture

FLUIDS = ("minecraft:water", "minecraft:lava")
FULL = 8 / 9  # The height of a source, blocks; each level below it is a ninth lower.
LAVA_LIGHT = 15
# A frame of the flowing texture is two blocks wide and high; the first quarter is one block.
_FLOW_SCALE = 0.5


def fluid_model(
    state: BlockState,
    texture_of: Callable[[str], Texture | None],
    tint: tuple[int, int, int] | None,
) -> BlockModel | None:
    """Return the model of water or lava, None where the packs have no texture of it.

    Args:
        state: with its ``level``: 0 a source, 1 to 7 lower and lower, 8 and more falling.
        texture_of: a texture's name to the packs' texture.
        tint: the colour of water; lava has its own.
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
    return FaceLook(flow if flows else still, uv * _FLOW_SCALE if flows else uv, tint)
