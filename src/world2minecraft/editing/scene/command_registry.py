"""All commands by name, and a parser for their JSON form."""

from typing import Any

from pydantic import ValidationError

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.editing.scene.command import Command
from world2minecraft.editing.scene.furniture_commands import AddObject, Rematch, SetTemplate
from world2minecraft.editing.scene.object_grouping import (
    MergeObjects,
    Recluster,
    RelabelObjects,
    SplitObject,
    SplitObjects,
)
from world2minecraft.editing.scene.object_naming import RenameObjects
from world2minecraft.editing.scene.object_placement import SnapObject
from world2minecraft.editing.scene.object_transforms import (
    DeleteObjects,
    DuplicateObject,
    MoveObject,
    TurnObjects,
)
from world2minecraft.editing.scene.repair import FillHoles, RemoveFloaters, Smooth
from world2minecraft.editing.scene.voxel_commands import (
    DeleteClass,
    DeleteComponent,
    FillBox,
    Paste,
    RelabelClass,
    SetCells,
)

COMMANDS: dict[str, type[Command]] = {
    kind.model_fields["op"].default: kind
    for kind in (
        SetCells,
        FillBox,
        DeleteComponent,
        Paste,
        RelabelClass,
        DeleteClass,
        RemoveFloaters,
        FillHoles,
        Smooth,
        AddObject,
        DeleteObjects,
        DuplicateObject,
        MergeObjects,
        MoveObject,
        Recluster,
        RelabelObjects,
        Rematch,
        RenameObjects,
        SetTemplate,
        SnapObject,
        SplitObject,
        SplitObjects,
        TurnObjects,
    )
}


def parse_command(value: Any) -> Command:
    """Parse a command from a JSON object.

    Raises:
        UsageError: If the value is not a valid command. The message states the field, the expected
            value and the given value.
    """
    if not isinstance(value, dict) or not isinstance(value.get("op"), str):
        raise UsageError('a command must be an object with "op", such as {"op": "set_cells", ...}')
    if value["op"] not in COMMANDS:
        raise UnknownNameError("command", value["op"], COMMANDS)
    try:
        return COMMANDS[value["op"]].model_validate(value)
    except ValidationError as error:
        raise UsageError(first_error(value["op"], error)) from error


def first_error(name: str, error: ValidationError) -> str:
    """Return a line about the first invalid field of a command or a query."""
    first = error.errors(include_url=False, include_context=False)[0]
    where = ".".join(str(part) for part in first["loc"]) or name
    given = str(first.get("input"))[:80]
    return f"{name}: {where}: {first['msg']}, not {given}"
