"""Functions that read the workspace and the JSON body of a request."""

from typing import Any

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
