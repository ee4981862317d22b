"""All commands on objects."""

from world2minecraft.editing.scene.command import Command
from world2minecraft.editing.scene.furniture_commands import AddObject, Rematch, SetTemplate
from world2minecraft.editing.scene.grouping import (
    MergeObjects,
    Recluster,
    RelabelObjects,
    SplitObject,
    SplitObjects,
)
from world2minecraft.editing.scene.objects import (
    DeleteObjects,
    DuplicateObject,
    MoveObject,
    TurnObjects,
)
from world2minecraft.editing.scene.snapping import SnapObject

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
