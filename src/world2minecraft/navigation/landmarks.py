"""Landmarks: the named objects of a scene, with colour, position and size.

The names are unique. Objects of the same kind are distinguished by colour, then by a neighbouring
object, and by a number only as a last resort.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES, SemanticClass, display_name
from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.vocabulary import MIN_NAME_CONFIDENCE
from world2minecraft.formats.object_names import NamedObject
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of, nearest_oklab

BESIDE_M = 1.5  # Maximum distance of objects that are "beside" each other.
MIN_SIZE_M = 0.15  # Minimum length of the two longer sides of a landmark.

# Names of blocks that are objects themselves; other blocks are named by their class.
_BLOCK_NOUNS = {
    "bookshelf": "bookcase",
    "chiseled_bookshelf": "bookcase",
    "chest": "chest",
    "ender_chest": "chest",
    "trapped_chest": "chest",
    "barrel": "barrel",
    "furnace": "furnace",
    "blast_furnace": "furnace",
    "smoker": "cooker",
    "crafting_table": "workbench",
    "jukebox": "jukebox",
    "lectern": "lectern",
    "cauldron": "cauldron",
    "enchanting_table": "enchanting table",
    "anvil": "anvil",
    "bell": "bell",
    "campfire": "campfire",
    "composter": "composter",
    "loom": "loom",
    "brewing_stand": "brewing stand",
}
_FURNITURE = "piece of furniture"  # The singular of the class name.
UNSPECIFIC_NOUNS = (_FURNITURE, "object")  # Names with these nouns never identify an object.
_NAME = re.compile(r"[^\W_][\w' -]*")  # Names without punctuation that would end a sentence.
_COLOURS = {
    "white": (235, 235, 235),
    "grey": (130, 130, 130),
    "black": (28, 28, 30),
    "red": (165, 40, 40),
    "orange": (225, 120, 35),
    "yellow": (240, 205, 70),
    "green": (90, 130, 50),
    "blue": (60, 80, 170),
    "light blue": (110, 175, 215),
    "purple": (125, 60, 165),
    "pink": (230, 150, 175),
    "brown": (110, 75, 45),
    "light brown": (175, 140, 90),
}


@dataclass(frozen=True, eq=False)
class Landmark:
    """A named object of a scene, with coordinates in metres of the room frame.

    Attributes:
        number: The instance ID in the volume.
        name: The unique name in the scene, such as "piano" or "chair beside the piano".
        noun: The noun without distinguishing words.
        class_id: The semantic class.
        colour: The name of the colour.
        center_m: The centre of the bounding box as float64 [3].
        size_m: The size of the bounding box as float64 [3].
        design: The furniture design, or "" if unknown.
        room: The index of the room, or -1.
        is_unambiguous: Whether a person can identify the object by its name. Names that end in a
            number, "object" and "piece of furniture" are ambiguous.
    """

    number: int
    name: str
    noun: str
    class_id: int
    colour: str
    center_m: np.ndarray
    size_m: np.ndarray
    design: str = ""
    room: int = -1
    is_unambiguous: bool = True

    @property
    def class_name(self) -> str:
        """The name of the semantic class."""
        return CLASS_NAMES[self.class_id]

    @property
    def low_m(self) -> np.ndarray:
        """The minimum corner of the bounding box as float64 [3]."""
        return self.center_m - self.size_m / 2

    @property
    def high_m(self) -> np.ndarray:
        """The maximum corner of the bounding box as float64 [3]."""
        return self.center_m + self.size_m / 2


def landmarks_of(
    volume: BlockVolume,
    designs: tuple[np.ndarray, Sequence[str]],
    titles: Mapping[str, str],
    room_of: Callable[[np.ndarray], int],
    *,
    names: Mapping[int, str] | None = None,
) -> tuple[Landmark, ...]:
    """Return the named objects of a volume, sorted by instance ID.

    Args:
        volume: The blocks, with instance IDs.
        designs: The index of each block's design as uint16 [X, Y, Z], and the design names, ""
            first.
        titles: The common name of each design.
        room_of: A function from a position in metres, float64 [3], to the index of its room.
        names: The noun of each named object by instance ID. It precedes that of the design.
    """
    codes, design_names = designs
    named = names or {}
    owned = np.flatnonzero((volume.instance.reshape(-1) > 0) & (volume.states.reshape(-1) > 0))
    order = owned[np.argsort(volume.instance.reshape(-1)[owned], kind="stable")]
    if not len(order):
        return ()
    numbers, firsts = np.unique(volume.instance.reshape(-1)[order], return_index=True)
    found = []
    for number, cells in zip(numbers, np.split(order, firsts[1:]), strict=True):
        class_id = _mode(volume.semantic.reshape(-1)[cells])
        if class_id not in OBJECT_CLASSES:
            continue
        design = design_names[_mode(codes.reshape(-1)[cells])]
        noun = named.get(int(number), titles.get(design, ""))
        landmark = _measure_landmark(volume, int(number), cells, class_id, design, noun)
        if np.sort(landmark.size_m)[1] >= MIN_SIZE_M:
            found.append(replace(landmark, room=room_of(landmark.center_m)))
    return assign_unique_names(found)


def nouns_of_names(objects: Iterable[NamedObject]) -> dict[int, str]:
    """Return the noun of each object by instance ID, for names that are sure enough.

    Names with marks that would end a sentence are left out.

    Example:
        >>> nouns_of_names([NamedObject(3, 11, "piano", 0.8), NamedObject(4, 11, "object", 0.2)])
        {3: 'piano'}
    """
    return {
        one.id: one.title
        for one in objects
        if one.name_confidence >= MIN_NAME_CONFIDENCE and _NAME.fullmatch(one.title)
    }


def assign_unique_names(landmarks: Sequence[Landmark]) -> tuple[Landmark, ...]:
    """Assign unique names to landmarks, from the noun, colour and neighbour, or a number."""
    nouns = Counter(one.noun for one in landmarks)
    coloured = Counter((one.colour, one.noun) for one in landmarks)
    specific = [one for one in landmarks if one.noun not in UNSPECIFIC_NOUNS]
    anchors = [one for one in specific if nouns[one.noun] == 1]
    phrases = [_phrase(one, nouns, coloured, anchors) for one in landmarks]
    total, seen, result = Counter(phrases), Counter[str](), []
    for one, phrase in zip(landmarks, phrases, strict=True):
        if total[phrase] == 1:
            result.append(
                replace(one, name=phrase, is_unambiguous=one.noun not in UNSPECIFIC_NOUNS)
            )
            continue
        seen[phrase] += 1
        result.append(replace(one, name=f"{phrase} {seen[phrase]}", is_unambiguous=False))
    return tuple(result)


def colour_name(rgb: np.ndarray) -> str:
    """Return the name of an sRGB colour, given as bytes [3].

    Example:
        >>> colour_name(np.array([160, 39, 34]))
        'red'
    """
    table = srgb_to_oklab(np.array(list(_COLOURS.values()), np.uint8))
    own = srgb_to_oklab(np.asarray(rgb, np.uint8)[None])
    return tuple(_COLOURS)[int(nearest_oklab(own, table)[0])]


def _measure_landmark(
    volume: BlockVolume,
    number: int,
    cells: np.ndarray,
    class_id: int,
    design: str,
    title: str,
) -> Landmark:
    at = np.stack(np.unravel_index(cells, volume.states.shape), axis=1) + np.array(volume.corner)
    ends = apply(volume.block_to_room, np.array([at.min(axis=0), at.max(axis=0) + 1], float))
    low, high = ends.min(axis=0), ends.max(axis=0)
    states = [volume.palette[row] for row in volume.states.reshape(-1)[cells]]
    colour = colour_name(colours_of(states).astype(float).mean(axis=0).round())
    noun = _noun(states, class_id, title)
    return Landmark(number, noun, noun, class_id, colour, (low + high) / 2, high - low, design)


def _noun(states: Sequence[str], class_id: int, title: str) -> str:
    if title:
        return title[0].lower() + title[1:] if title[1:2].islower() else title
    block = Counter(state.partition("[")[0].split(":")[-1] for state in states).most_common(1)[0][0]
    known = _FURNITURE if class_id == SemanticClass.FURN else display_name(class_id)
    return _BLOCK_NOUNS.get(block, known)


def _phrase(one: Landmark, nouns: Counter, coloured: Counter, anchors: Sequence[Landmark]) -> str:
    if nouns[one.noun] == 1:
        return one.noun
    if coloured[one.colour, one.noun] == 1 and not set(one.noun.split()) & set(_COLOURS):
        return f"{one.colour} {one.noun}"
    same = [other for other in anchors if other.room == one.room]
    gaps = [gap_between_m(one, other) for other in same]
    if gaps and min(gaps) <= BESIDE_M:
        return f"{one.noun} beside the {same[int(np.argmin(gaps))].noun}"
    return one.noun


def gap_between_m(one: Landmark, other: Landmark) -> float:
    """Return the distance between the boxes of two landmarks in metres."""
    gap = np.maximum(0.0, np.maximum(one.low_m - other.high_m, other.low_m - one.high_m))
    return float(np.linalg.norm(gap))


def _mode(values: np.ndarray) -> int:
    found, counts = np.unique(values, return_counts=True)
    return int(found[counts.argmax()])
