"""What the things of the built world show: the names of furniture, and the NYU40 classes of these.

An object shows what its templates show; built from its own cells, it shows its own name. An object
whose name is only that of a class such as furniture or object has no name.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES, STRUCTURE_CLASSES, SemanticClass
from world2minecraft.core.types import OWN_CELLS, ObjectInstance, Placement
from world2minecraft.core.vocabulary import (
    MIN_NAME_CONFIDENCE,
    ThingName,
    alike_nyu40,
    nyu40_classes,
    read_vocabulary,
)
from world2minecraft.furniture import template

VAGUE = (CLASS_DISPLAY_NAMES[SemanticClass.FURN], CLASS_DISPLAY_NAMES[SemanticClass.OBJS])


@dataclass(frozen=True)
class BuiltThing:
    """What a thing of the world shows.

    Attributes:
        titles: Names for people, such as ``bookcase``.
        nyu40: NYU40 classes, 1 to 40, that agree with these names. Empty if it has no name.
    """

    titles: tuple[str, ...]
    nyu40: frozenset[int]


def built_thing(instance: ObjectInstance, placements: Iterable[Placement]) -> BuiltThing:
    """Return what an object shows that is built with its placements."""
    entries = [entry_of(instance, one) for one in placements if one.object_id == instance.id]
    named = sorted({entry.name: entry for entry in entries if entry is not None}.items())
    titles = tuple(entry.title for _, entry in named) or (CLASS_DISPLAY_NAMES[instance.class_id],)
    groups = [alike_nyu40(entry.nyu40) for _, entry in named]
    return BuiltThing(titles, frozenset().union(*groups))


def entry_of(instance: ObjectInstance, placement: Placement) -> ThingName | None:
    """Return the name that one placement of an object shows, or None."""
    vocabulary = read_vocabulary()
    if placement.template != OWN_CELLS:
        return vocabulary.of_template(placement.template)
    return None if instance.name in VAGUE else vocabulary.names.get(instance.name)


def built_structure() -> dict[int, BuiltThing]:
    """Return what walls, floors, ceilings and windows show, by their class."""
    table = nyu40_classes()
    return {
        number: BuiltThing(
            (CLASS_DISPLAY_NAMES[number],), frozenset(np.flatnonzero(table == number).tolist())
        )
        for number in STRUCTURE_CLASSES
    }


def stands_for(instance: ObjectInstance, placements: Sequence[Placement]) -> bool:
    """Return whether what is built can stand for an object.

    Each template must show the object's name, if the object has one that is sure, or else be of
    the object's class. Its own cells stand for any object.
    """
    built = [one for one in placements if one.object_id == instance.id]
    return bool(built) and all(_stands_for(instance, one) for one in built)


def _stands_for(instance: ObjectInstance, placement: Placement) -> bool:
    if placement.template == OWN_CELLS:
        return True
    own = read_vocabulary().names.get(instance.name)
    shown = read_vocabulary().of_template(placement.template)
    sure = instance.name not in VAGUE and instance.name_confidence >= MIN_NAME_CONFIDENCE
    if own is not None and shown is not None and sure:
        return shown.name == own.name or shown.nyu40 in alike_nyu40(own.nyu40)
    return template(placement.template).class_id == instance.class_id
