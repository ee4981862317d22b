"""The blocks available in each shape, and the block closest to a colour.

Wood and many stones exist as slabs and stairs, dyed blocks do not: a clear red has an error of 3
(dE76) as a full block and of 24 as a slab. Objects are therefore fitted only with the kinds of
shape that exist in their colours.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.construction.fitting.shapes import Shape
from world2minecraft.construction.palettes import Palette
from world2minecraft.core.classes import SemanticClass
from world2minecraft.furniture.materials import without_holes
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of
from world2minecraft.minecraft.block_table import block_table

ENOUGH = 0.5  # The share of an object's colours that a kind must have for the object to use it.
# Oklab distances that a colour may lose to a shape of the kind; of a post little is seen.
MAX_COLOUR_LOSS = {"slab": 0.03, "stairs": 0.03, "trapdoor": 0.04, "post": 0.1, "carpet": 0.03}
MARGIN = 0.06  # How far a shape may look off the full block that it stands for.
WEIGHTS = np.array([1.0, 1.6, 1.6])  # Red made brown is worse than red made dark.
FAINT, FADED = 0.015, 2.2  # Chroma that is noise, and what fading weighs above twice that.
OWN = 0.1  # How far a shape of a block's own material may look off it.
SAME = 0.04  # A shape of a block's own material, or of one that looks the same.
HANDICAPS = {"iron_trapdoor": 0.02}  # Taken only where it is clearly nearer.
# Screens are not made of wood, and no panel is black enough. On cushions, trapdoors look like
# grilles and planks like crates.
EXCLUDED_KINDS = {
    int(SemanticClass.TVS): frozenset(("trapdoor", "stairs")),
    int(SemanticClass.SOFA): frozenset(("trapdoor", "post")),
    int(SemanticClass.BED): frozenset(("trapdoor",)),
}
UPHOLSTERED = (int(SemanticClass.SOFA),)
WOODEN = ("_planks", "_wood")


@dataclass(frozen=True, eq=False)
class Materials:
    """The blocks of each kind of shape that a palette offers, with their Oklab colours."""

    blocks: dict[str, tuple[str, ...]]
    own: dict[str, dict[str, str]]  # of each kind: full block -> the block of its own material
    colours: dict[str, np.ndarray]  # float32 [M, 3]
    handicaps: dict[str, np.ndarray]  # float64 [M]

    def kinds_for(
        self,
        colours: np.ndarray,
        full: tuple[str, ...],
        handicaps: np.ndarray,
        class_id: int,
        lightness_weight: float,
    ) -> frozenset[str]:
        """Return the kinds of shape that exist in an object's colours.

        Args:
            colours: Oklab colours, float32 [N, 3]; an empty array allows every kind.
            full: M full blocks that the object may be made of.
            handicaps: Oklab distances added to that of each full block, float64 [M].
            class_id: Class of the object.
            lightness_weight: Weight of lightness compared to hue and chroma.
        """
        offered = [kind for kind in self.blocks if kind not in EXCLUDED_KINDS.get(class_id, ())]
        if not len(colours):
            return frozenset(("full", *offered))
        light = lightness_weight
        every = _distances(colours, srgb_to_oklab(colours_of(full)), light, handicaps)
        nearest, best = np.array(full, object)[every.argmin(1)], every.min(1)
        kinds = {"full"}
        for kind in offered:
            distances = _distances(colours, self.colours[kind], light, self.handicaps[kind]).min(1)
            near = distances - best <= MAX_COLOUR_LOSS[kind]
            near |= np.isin(nearest, list(self.own[kind]))
            if near.mean() >= ENOUGH:
                kinds.add(kind)
        return frozenset(kinds)

    def _distances_to(self, kind: str, wanted: np.ndarray) -> np.ndarray:
        """Return the distances of a kind's blocks from Oklab colours [N, 3], float64 [N, M]."""
        distances = np.linalg.norm((wanted[:, None] - self.colours[kind]) * WEIGHTS, axis=2)
        return np.round(distances + self.handicaps[kind], 6)

    def existing(self, kind: str, full: tuple[str, ...]) -> tuple[str, ...]:
        """Return the full blocks that exist as a kind of shape, exactly or in a similar colour."""
        distances = self._distances_to(kind, srgb_to_oklab(colours_of(full))).min(1)
        near = {block for block, off in zip(full, distances.tolist(), strict=True) if off <= SAME}
        return tuple(block for block in full if block in near or block in self.own[kind])

    def in_all(self, kinds: Sequence[str], full: tuple[str, ...]) -> tuple[str, ...]:
        """Return the full blocks that exist in all given kinds of shape, or in all except posts."""
        for few in (kinds, [kind for kind in kinds if kind != "post"]):
            held = [set(self.existing(kind, full)) for kind in few]
            able = tuple(block for block in full if all(block in one for one in held))
            if able:
                return able
        return ()

    def shaped_state(self, shape: Shape, block: str) -> str | None:
        """Return the state of a shape in the colour of a full block, or None if there is none."""
        if shape.kind == "full":
            return block
        if block in self.own[shape.kind]:
            return shape.of(self.own[shape.kind][block])
        distances = self._distances_to(shape.kind, srgb_to_oklab(colours_of([block])))[0]
        best = int(distances.argmin())
        if shape.kind != "post" and distances[best] > MARGIN:
            return None
        return shape.of(self.blocks[shape.kind][best])


def _distances(colours, offered, light, handicaps) -> np.ndarray:
    """Return the distances of Oklab colours [N, 3] from others [M, 3], float64 [N, M].

    Turning a saturated colour grey has the highest cost: a teal curtain of stone is grey.
    """
    own, other = (np.hypot(one[:, 1], one[:, 2]) for one in (colours, offered))
    clear = np.clip((own - FAINT) / FAINT, 0, 1)[:, None]
    faded = (1 + (FADED - 1) * clear) * (other < own[:, None]) + (other >= own[:, None])
    square = (colours[:, None] - offered) ** 2
    distances = light * square[..., 0] + (WEIGHTS[1] * faded) ** 2 * (
        square[..., 1] + square[..., 2]
    )
    return np.sqrt(distances) + handicaps


def materials_of(palette: Palette, *, wood: bool = True) -> Materials:
    """Return the shapes in which the blocks of a palette exist, with or without those of wood."""
    full = sorted({block for blocks in palette.blocks.values() for block in blocks})
    slabs, fences = (
        {
            block: name
            for block, name in names.items()
            if block in full and (wood or not is_wooden(block))
        }
        for names in (palette.slabs, palette.fences)
    )
    woods = {block: name for block, name in fences.items() if "nether_brick" not in name}
    own = {
        "slab": slabs,
        "stairs": {block: name.replace("_slab", "_stairs") for block, name in slabs.items()},
        "trapdoor": {block: name.replace("_fence", "_trapdoor") for block, name in woods.items()},
        "post": fences,
        "carpet": {b: b.replace("_wool", "_carpet") for b in full if b.endswith("_wool")},
    }
    own["trapdoor"] = {b: name for b, name in own["trapdoor"].items() if not has_holes(name)}
    known = {kind: _alike(_known(names)) for kind, names in own.items()}
    more = {"trapdoor": ["minecraft:iron_trapdoor"]} if wood else {}
    blocks = {
        kind: tuple(sorted({*names.values(), *more.get(kind, ())}))
        for kind, names in known.items()
        if names
    }
    return Materials(
        blocks,
        {kind: known[kind] for kind in blocks},
        {kind: srgb_to_oklab(colours_of(names)) for kind, names in blocks.items()},
        {
            kind: np.array([HANDICAPS.get(name.partition(":")[2], 0.0) for name in names])
            for kind, names in blocks.items()
        },
    )


def has_holes(name: str) -> bool:
    """Return whether a trapdoor has holes: as tops and sides, such look like grilles."""
    full = name if ":" in name else f"minecraft:{name}"
    return without_holes(full) != full


def is_wooden(block: str) -> bool:
    """Return whether a full block is of wood."""
    return any(word in block for word in WOODEN)


def _known(names: Mapping[str, str]) -> dict[str, str]:
    """Return the pairs whose second block exists in the game, by its full name."""
    full = {block: name if ":" in name else f"minecraft:{name}" for block, name in names.items()}
    return {block: name for block, name in full.items() if name in block_table().blocks}


def _alike(names: Mapping[str, str]) -> dict[str, str]:
    """Return the pairs of blocks that look alike; an oak trapdoor is darker than stripped oak."""
    if not names:
        return {}
    colours = [srgb_to_oklab(colours_of(list(side))) for side in (names, names.values())]
    distances = np.linalg.norm(colours[0] - colours[1], axis=1)
    return {
        block: name
        for (block, name), off in zip(names.items(), distances, strict=True)
        if off <= OWN
    }
