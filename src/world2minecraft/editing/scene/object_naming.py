"""Names of scene objects: the command that changes them, and rules for other commands."""

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from world2minecraft.core.classes import display_name
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import ObjectInstance, Operation, SceneObject
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.editing.scene.cell_patch import Patch
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.object_boxes import common_class, objects_by_ids
from world2minecraft.editing.scene.object_transforms import Ids
from world2minecraft.editing.scene.scene_draft import SceneDraft

MAX_NAME = 60


def _one_line(text: str) -> str:
    plain = " ".join(text.split())
    if not plain.isprintable():
        raise ValueError("a name must be one line of printable text")
    return plain


ObjectName = Annotated[str, Field(max_length=MAX_NAME), AfterValidator(_one_line)]


class RenameObjects(Command):
    """Name objects, such as ``piano``. An empty name restores the display name of the class.

    Synonyms of the vocabulary become its names: ``couch`` becomes ``sofa``. Other text is kept as
    it is. The class does not change.
    """

    op: Literal["rename_objects"] = "rename_objects"
    ids: Ids
    name: ObjectName

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the renamed objects."""
        ones = objects_by_ids(draft, self.ids)
        renamed = [(one, self._renamed(one)) for one in ones]
        objects = [new for one, new in renamed if new.name != one.name]
        if not objects:
            raise UsageError("nothing to change: all objects already have this name")
        return Patch(draft).plan_operation(
            "rename_objects", objects=objects, class_id=common_class(objects)
        )

    def _renamed(self, one: SceneObject) -> SceneObject:
        if not self.name:
            return replace(one, name=display_name(one.class_id), name_confidence=0.0)
        entry = read_vocabulary().find(self.name)
        return replace(one, name=entry.name if entry else self.name, name_confidence=1.0)


def with_name_of(one: SceneObject | None, found: ObjectInstance) -> ObjectInstance:
    """Return an object with the name of the one that it replaces, if both have the same class."""
    if one is None or one.class_id != found.class_id:
        return found
    return replace(found, name=one.name, name_confidence=one.name_confidence)


def with_class(one: SceneObject, class_id: int) -> SceneObject:
    """Return an object with another class and without furniture.

    A name of the vocabulary that belongs to another class is removed.
    """
    entry = read_vocabulary().names.get(one.name)
    keeps = entry.class_id == class_id if entry else one.name != display_name(one.class_id)
    named = {} if keeps else {"name": "", "name_confidence": 0.0}
    return replace(one, class_id=class_id, confidence=1.0, placements=(), **named)
