"""What a request is about: the workspace that it is for, and the JSON object that it brings."""

from typing import Any

from starlette.requests import Request

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge.server.limits import parse_json
from world2minecraft.sceneforge.workspace import Workspace


def get_workspace(request: Request) -> Workspace:
    """Return the workspace of the server.

    Raises:
        UsageError: the server has none.
    """
    workspace = getattr(request.app.state, "workspace", None)
    if workspace is None:
        raise UsageError("this server has no start page; run w2m forge without a path")
    return workspace


async def read_json_object(request: Request) -> dict[str, Any]:
    """Return the JSON object of a request's body; an empty body is an empty object.

    Raises:
        UsageError: it is none.
    """
    body = await request.body()
    value = parse_json(body) if body else {}
    if not isinstance(value, dict):
        raise UsageError("the body must be a JSON object")
    return value
