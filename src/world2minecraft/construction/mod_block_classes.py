"""Meanings of mod blocks: map block ids to classes and designs by words in their names.

Furniture mods name hundreds of blocks by a few words, so a palette lists these words. The longest
word in a block's name decides; of equally long words, the last one.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.types import BlockVolume
from world2minecraft.geometry.connected_components import label_components

LONGEST_WORD = 60
MAX_OBJECTS = 65_535


class Meaning(NamedTuple):
    """A class, and the furniture design that shows it best ("" if there is none)."""

    class_id: int
    design: str


@dataclass(frozen=True, eq=False)
class Meanings:
    """The word list of a palette, and the namespace prefixes of the blocks to which it applies."""

    namespaces: tuple[str, ...]
    words: Mapping[str, Meaning]

    @cached_property
    def _by_length(self) -> list[str]:
        return sorted(self.words, key=len, reverse=True)

    def of(self, state: str) -> Meaning | None:
        """Return the meaning of a block state, or None if no word matches.

        Example:
            >>> Meanings(("mod",), {"chair": Meaning(5, "chair")}).of("mod:oak_chair[facing=east]")
            Meaning(class_id=5, design='chair')
        """
        namespace, _, name = state.partition("[")[0].rpartition(":")
        if not (namespace or "minecraft").startswith(self.namespaces):
            return None
        found = [word for word in self._by_length if word in name]
        if not found:
            return None
        alike = [word for word in found if len(word) == len(found[0])]
        return self.words[max(alike, key=name.rfind)]


def parse_meanings(raw: Any) -> Meanings:
    """Parse the ``reads`` entry of a palette file.

    Raises:
        ValueError: If the entry is invalid.
    """
    if not isinstance(raw, dict) or set(raw) != {"namespaces", "words"}:
        raise ValueError("reads must contain exactly the keys namespaces and words")
    spaces, words = raw["namespaces"], raw["words"]
    if not (isinstance(spaces, list) and spaces and all(isinstance(s, str) and s for s in spaces)):
        raise ValueError(f"namespaces must be a list of names, got {spaces!r}")
    if not isinstance(words, dict) or not words:
        raise ValueError(
            f"words must map words to meanings, such as stool: chair/stool, got {words!r}"
        )
    return Meanings(tuple(spaces), {str(w): _meaning(str(w), text) for w, text in words.items()})


def label_volume(volume: BlockVolume, meanings: Meanings) -> BlockVolume:
    """Assign classes and instances to the blocks of a volume whose meaning is known.

    Face-connected blocks of the same design form one object; structure blocks form none. Existing
    labels of the volume are kept.
    """
    known = [meanings.of(state) for state in volume.palette]
    classes = np.array([0 if one is None else one.class_id for one in known], np.uint8)
    designs = sorted({one.design for one in known if one is not None})
    kinds = np.array([0 if one is None else 1 + designs.index(one.design) for one in known])
    semantic = np.where(volume.semantic > 0, volume.semantic, classes[volume.states])
    instance = volume.instance.copy()
    here = kinds[volume.states] * np.isin(semantic, OBJECT_CLASSES) * (volume.instance == 0)
    following = int(instance.max(initial=0))
    keys = here * len(CLASS_NAMES) + semantic
    for key in np.unique(keys[here > 0]).tolist():
        parts, count = label_components((keys == key) & (here > 0), corners=False)
        if following + count > MAX_OBJECTS:
            break
        instance[parts > 0] = (parts[parts > 0] + following).astype(np.uint16)
        following += count
    return replace(volume, semantic=semantic, instance=instance)


def _meaning(word: str, text: Any) -> Meaning:
    name, _, design = str(text).partition("/")
    if not 0 < len(word) <= LONGEST_WORD or name not in CLASS_NAMES:
        classes = ", ".join(CLASS_NAMES)
        raise ValueError(
            f"the meaning of {word!r} must be CLASS or CLASS/DESIGN, such as chair/stool, "
            f"got {text!r}; classes: {classes}"
        )
    return Meaning(CLASS_NAMES.index(name), design)
