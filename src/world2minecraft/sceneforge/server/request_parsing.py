"""Functions that read the workspace, the JSON body and the options of a request."""

from contextlib import suppress
from types import UnionType
from typing import Any

import numpy as np
from starlette.requests import Request

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge.server.limits import parse_json
from world2minecraft.sceneforge.workspace import Workspace


def get_workspace(request: Request) -> Workspace:
    """Return the workspace of the server that received a request.

    Raises:
        UsageError: If the server has no workspace.
    """
    workspace = getattr(request.app.state, "workspace", None)
    if workspace is None:
        raise UsageError("this server has no start page; run w2m forge without a path")
    return workspace


async def read_json_object(request: Request) -> dict[str, Any]:
    """Return the JSON object in the body of a request, or an empty object if the body is empty.

    Raises:
        UsageError: If the body is not a JSON object.
    """
    body = await request.body()
    value = parse_json(body) if body else {}
    if not isinstance(value, dict):
        raise UsageError("the body must be a JSON object")
    return value


def parse_point(name: str, value: Any, example: str) -> tuple[float, float, float]:
    """Return three numbers of a request, such as a position in metres.

    Args:
        name: Name of the option.
        value: The numbers, or texts of numbers.
        example: A valid value, for the message of an error.

    Raises:
        UsageError: If the value is not three finite numbers.
    """
    try:
        x, y, z = (float(number) for number in value)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"{name} must be three numbers, such as {example}") from error
    if not np.isfinite([x, y, z]).all():
        raise UsageError(f"{name} must be three finite numbers, such as {example}")
    return x, y, z


def parse_scale(value: Any, kinds: type | UnionType) -> float:
    """Return the blocks per metre of a request.

    Args:
        value: The given value.
        kinds: Allowed types of the value.

    Raises:
        UsageError: If the value is not a number.
    """
    with suppress(ValueError, OverflowError):
        if isinstance(value, kinds):
            return float(value)
    raise UsageError(f"blocks_per_metre must be a number such as 4, got {value!r:.40}")
