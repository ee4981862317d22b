"""``ResourcePackModels``: the user's resource packs and client jars as a model source.

A block state is converted to the parts in its block state file, each part to its model, and each
model to its rotated elements. Problems are recorded, and the next source is used.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.visual_shapes import is_luminous
from world2minecraft.rendering.block_elements import BlockModel, Element
from world2minecraft.rendering.resource_packs.elements import (
    apply_quarter_turn,
    element_of,
    merge_coincident,
    quarter_turn,
)
from world2minecraft.rendering.resource_packs.model_json import (
    MAX_ELEMENTS,
    ModelPart,
    flatten_model,
    select_parts,
    texture_of,
)
from world2minecraft.rendering.resource_packs.pack_files import PackStack
from world2minecraft.rendering.resource_packs.texture_only_models import (
    FLUIDS,
    fluid_model,
    implied_model,
    other_names,
)
from world2minecraft.rendering.resource_packs.textures import (
    CLEAR,
    MAX_PX,
    PackTextures,
    names_clear_material,
)
from world2minecraft.rendering.resource_packs.tints import Colour, checked_tints, tint_rule
from world2minecraft.rendering.texture import Texture

FULL_LIGHT = 15
MAX_TOTAL_ELEMENTS = 200_000  # A thousand states of the game have about 5,000.


class ResourcePackModels:
    """The models and textures of a stack of resource packs, client jars and mod jars.

    ``problems`` contains a short sentence for each of the first files that could not be read;
    ``problem_count`` counts all.

    Args:
        paths: Folders, zips and jars. Later packs override earlier ones, as in the game.
        tints: Colours that replace those of the plains biome; see ``tints.PLAINS`` for the names.
        most_px: Maximum side of a texture. Larger textures are reduced to it.

    Raises:
        InputError: If a pack does not exist or is not a resource pack.
        UsageError: If a tint or ``most_px`` is invalid.
    """

    def __init__(
        self,
        paths: Sequence[str | Path],
        *,
        tints: Mapping[str, Colour] | None = None,
        most_px: int = MAX_PX,
    ):
        if most_px < 1 or most_px & (most_px - 1):
            raise UsageError(f"most_px must be a power of two such as 64, got {most_px}")
        self._resources = PackStack(paths)
        self._textures = PackTextures(self._resources, most_px)
        self._tints = checked_tints(tints, self._textures.map_colour)
        self._element_count = 0
        self._models: dict[str, BlockModel | None] = {}

    @property
    def problems(self) -> list[str]:
        """The first problems so far, as short sentences."""
        return list(self._resources.problems)

    @property
    def problem_count(self) -> int:
        """The number of problems so far."""
        return self._resources.problem_count

    @property
    def summary(self) -> str:
        """A sentence about the problems so far, or an empty string."""
        if not self.problem_count:
            return ""
        first, count = self._resources.problems[0], self.problem_count
        problems = "1 problem" if count == 1 else f"{count} problems"
        return f"{problems} in the resource packs, first: {first}"

    @property
    def texture_px(self) -> int:
        """The most common texture size of the packs, 16 to 128, suitable for a scene."""
        return self._textures.usual_px()

    def model(self, state: str) -> BlockModel | None:
        """Return the model of a state given as text, or None if no pack has a readable one."""
        if state not in self._models:
            model = self._made(state)
            self._models[state] = _shining(model) if model and is_luminous(state) else model
        return self._models[state]

    def texture(self, name: str) -> Texture | None:
        """Return the texture of a name that ``model`` uses, or None."""
        return None if name.startswith("own:") else self._textures.get(name)

    def _made(self, text: str) -> BlockModel | None:
        try:
            state = complete(parse_state(text))
        except UsageError:
            return None
        if state.name in FLUIDS:
            return fluid_model(state, self._present, self._tints["water"])
        space, block = state.name.split(":")
        names = [f"assets/{space}/blockstates/{n}.json" for n in (block, *other_names(state.name))]
        for name in names:
            root = self._resources.object(name)
            if root is not None:
                try:
                    return self._drawn(state, select_parts(root, dict(state.properties)))
                except ValueError as error:
                    self._resources.note(f"{state.name}: {error}")
                    break
        is_free = not any(self._resources.has(name) for name in names)
        return implied_model(state, self._present, tint_rule(state, self._tints), is_free)

    def _present(self, name: str) -> Texture | None:
        """Return the texture of a name, None where there is none, which is no problem."""
        space, _, path = name.partition(":")
        has_file = self._resources.has(f"assets/{space}/textures/{path}.png")
        return self.texture(name) if has_file else None

    def _drawn(self, state: BlockState, parts: tuple[ModelPart, ...]) -> BlockModel | None:
        """Return the parts' elements as one model; None where the game draws a part in code."""
        tint_of = tint_rule(state, self._tints)
        ending = CLEAR if names_clear_material(state.name) else ""
        elements: list[Element] = []
        occlusion = True
        for part in parts:
            flat = flatten_model(part.model, self._resources)
            turn = quarter_turn(part.x_deg, part.y_deg, part.z_deg)
            named = partial(_texture_name, textures=flat.textures, ending=ending)
            for raw in flat.elements:
                elements.append(
                    apply_quarter_turn(element_of(raw, named, tint_of), turn, part.uv_lock)
                )
            occlusion = occlusion and flat.ambient_occlusion
            if len(elements) > MAX_ELEMENTS:
                raise ValueError(f"the models have more than {MAX_ELEMENTS:,} elements in total")
        self._element_count += len(elements)
        if self._element_count > MAX_TOTAL_ELEMENTS:
            raise ValueError(
                f"the packs exceed the limit of {MAX_TOTAL_ELEMENTS:,} elements in total"
            )
        self._check_textures(elements)
        return BlockModel(merge_coincident(elements), occlusion) if elements else None

    def _check_textures(self, elements: Sequence[Element]) -> None:
        """Raise ValueError where a face's texture cannot be read."""
        for name in {face.texture for one in elements for face in one.faces if face is not None}:
            if self.texture(name) is None:
                plain = name.removesuffix(CLEAR)
                raise ValueError(f"texture {plain} not found in the packs or not readable")


def _shining(model: BlockModel) -> BlockModel:
    """Return a lamp's model, seen at full brightness; files do not say which blocks are lamps."""
    elements = tuple(replace(one, emission=one.emission or FULL_LIGHT) for one in model.elements)
    return replace(model, elements=elements)


def _texture_name(face: str, textures: Mapping[str, object], ending: str) -> str:
    """Return the name of a face's texture, marked if the block is of a transparent material."""
    name = texture_of(face, textures)
    return name if not ending or names_clear_material(name) else name + ending
