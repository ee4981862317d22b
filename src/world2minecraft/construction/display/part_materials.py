"""The block of each furniture part, chosen by the material of its role and its real colour."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from world2minecraft.construction.display.boxes import Frame
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.surface_painting import FADED, colour_costs
from world2minecraft.core.coordinates import apply, invert
from world2minecraft.furniture import Part, Template
from world2minecraft.furniture.materials import FIXED, Material, list_swatches
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.visual_shapes import is_luminous

# Squared distance by which a block of the role's own kind may lie farther off than the nearest
# block of all that its class may be of: so wood stays wood, and a red door turns red concrete.
OWN_KIND = 0.12
GLOWING = "minecraft:ochre_froglight[axis=y]"  # A warm white cube in the place of a small lantern.
MIN_CELLS = 3  # Fewer say nothing of a role's colour.
SAME_ROLE = 0.07  # Oklab distance of two roles of one kind that are of one paint.
BESIDE = 1.5  # Cells: how far from a part a cell may lie that colours it. Scans are that noisy.


def states_of_parts(
    found: Template,
    parts: Sequence[Part],
    colours: Mapping[str, np.ndarray],
    palette: Palette,
    parameters: BuildParameters,
) -> list[str]:
    """Return the block state of each part of a template.

    Args:
        found: The template, whose materials state what each role is made of.
        parts: The parts of the template.
        colours: Known Oklab colours by role, float32 [3]; the key "" is the whole object.
        palette: Blocks allowed for each class.
        parameters: Weights of the colour comparison.
    """
    roles = tuple(dict.fromkeys(part.role for part in parts))
    sizes = {role: sum(_size(one) for one in parts if one.role == role) for role in roles}
    main = max(roles, key=lambda role: (round(sizes[role], 9), role))
    choose = partial(
        _state_of_role, class_id=found.class_id, palette=palette, parameters=parameters
    )
    whole = colours.get(main, colours.get(""))
    chosen = {main: choose(found.materials.get(main), whole, True)}
    for role in roles:
        material = found.materials.get(role)
        if role not in colours and _is_alike(material, found.materials.get(main)):
            chosen[role] = chosen[main]
        elif role != main:
            colour = colours.get(role, whole)
            chosen[role] = choose(material, colour, role in colours)
    return [chosen[part.role] for part in parts]


def _is_alike(one: Material | None, main: Material | None) -> bool:
    """Return whether an unseen role has the same kind of material as most of its object."""
    if one is None or main is None:
        return one is main
    return one.takes_colour and main.takes_colour and one.kind == main.kind


def _size(part: Part) -> float:
    return float(np.prod(part.box_m[3:] - part.box_m[:3]))


def role_colours(
    parts: Sequence[Part],
    frame: Frame,
    centres_m: np.ndarray,
    colours: np.ndarray,
    voxel_m: float,
    kinds: Mapping[str, str],
) -> dict[str, np.ndarray]:
    """Compute the colour of each role from the cells in or next to its parts, Oklab float32 [3].

    Roles with the same kind of material and similar colours share one colour. The key "" contains
    the colour of the whole object.

    Args:
        parts: Boxes of the object in its own frame.
        frame: Frame of the object in the room.
        centres_m: Centres of the object's cells in the room in metres, float64 [N, 3].
        colours: Colours of these cells, float32 [N, 3].
        voxel_m: Cell size in metres.
        kinds: Kind of material of each role.
    """
    if not len(colours):
        return {}
    result = {"": np.median(colours, axis=0)}
    local = apply(invert(frame.object_to_room), centres_m)
    boxes = np.array([part.box_m for part in parts]).reshape(-1, 2, 3)
    outside = np.maximum(boxes[None, :, 0] - local[:, None], local[:, None] - boxes[None, :, 1])
    away = np.linalg.norm(np.maximum(outside, 0), axis=2)
    # Inside several parts the one whose surface is nearest says more: scans see surfaces.
    away += np.where(away == 0, 1e-3 * np.abs(outside.max(axis=2)), 0)
    nearest = away.argmin(axis=1)
    near = away.min(axis=1) <= BESIDE * voxel_m
    roles = np.array([part.role for part in parts])[nearest]
    counts = {role: int(((roles == role) & near).sum()) for role in dict.fromkeys(roles.tolist())}
    for role in sorted(counts, key=lambda name: (-counts[name], name)):
        if counts[role] < MIN_CELLS:
            continue
        colour = np.median(colours[(roles == role) & near], axis=0)
        alike = (
            result[name]
            for name in result
            if name
            and kinds.get(name) == kinds.get(role)
            and np.linalg.norm(result[name] - colour) <= SAME_ROLE
        )
        result[role] = next(alike, colour)
    return result


def nearest_state(
    colour: np.ndarray, choices: Sequence[str], parameters: BuildParameters
) -> tuple[str, float]:
    """Return the block state closest to an Oklab colour, and its distance."""
    none = np.zeros(len(choices))
    costs = colour_costs(colour[None], choices, parameters.lightness_weight, none, FADED)[0]
    best = int(costs.argmin())
    return choices[best], float(np.sqrt(costs[best]))


def _state_of_role(
    material: Material | None,
    colour: np.ndarray | None,
    seen: bool,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
) -> str:
    plain = palette.blocks[class_id]
    if material is None:
        return (
            palette.defaults[class_id]
            if colour is None
            else nearest_state(colour, plain, parameters)[0]
        )
    own = _whole(material, palette.defaults[class_id])
    if material.kind == FIXED or not material.takes_colour or colour is None:
        return own
    kind = [_full(swatch.sample) for swatch in list_swatches(material.kind, frozenset({"full"}))]
    allowed = [state for state in kind if palette.allows(state)]
    best, away = nearest_state(colour, plain, parameters)
    if not allowed:
        return best
    same, distance = nearest_state(colour, allowed, parameters)
    if distance <= away + OWN_KIND:
        return same
    return best if seen else own  # The wooden legs of a blue chair are not blue.


def _whole(material: Material, default: str) -> str:
    """Return the full block of a material, since only cubes can be stretched."""
    name = material.block("full")
    if name is None:
        return default
    state = _full(name)
    if is_full_cube(state):
        return state
    return GLOWING if is_luminous(state) else default


def _full(name: str) -> str:
    return str(complete(parse_state(name)))
