"""All commands on objects."""

from world2minecraft.edit.scene.command import Command
from world2minecraft.edit.scene.furnishing import AddObject, Rematch, SetTemplate
from world2minecraft.edit.scene.objects import (
    DeleteObjects,
    DuplicateObject,
    MoveObject,
    TurnObjects,
)

OBJECT_COMMANDS: tuple[type[Command], ...] = (
    AddObject,
    DeleteObjects,
    DuplicateObject,
    MoveObject,
    Rematch,
    SetTemplate,
    TurnObjects,
)
