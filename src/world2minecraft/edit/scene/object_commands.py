"""All commands on objects."""

from world2minecraft.edit.scene.command import Command
from world2minecraft.edit.scene.furnishing import AddObject, Rematch, SetTemplate
from world2minecraft.edit.scene.grouping import (
    MergeObjects,
    Recluster,
    RelabelObjects,
    SplitObject,
    SplitObjects,
)
from world2minecraft.edit.scene.objects import (
    DeleteObjects,
    DuplicateObject,
    MoveObject,
    TurnObjects,
)
from world2minecraft.edit.scene.snapping import SnapObject

OBJECT_COMMANDS: tuple[type[Command], ...] = (
    AddObject,
    DeleteObjects,
    DuplicateObject,
    MergeObjects,
    MoveObject,
    Recluster,
    RelabelObjects,
    Rematch,
    SetTemplate,
    SnapObject,
    SplitObject,
    SplitObjects,
    TurnObjects,
)
