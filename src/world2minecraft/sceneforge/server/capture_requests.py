"""What the start page and the phone page ask of a capture: to receive bytes, and to be ready."""

import asyncio
from collections.abc import AsyncIterator

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from world2minecraft.core.errors import ConflictError, UsageError
from world2minecraft.sceneforge.server.error_messages import explain_error
from world2minecraft.sceneforge.uploads import CaptureFolder
from world2minecraft.sceneforge.workspace import Workspace

CHUNK_BYTES = 4 << 20  # Bytes per request; a lost connection loses at most one chunk.
MAX_SILENCE_S = 10.0  # A lost Wi-Fi ends no connection; it only falls silent.


async def receive_part(request: Request, one: CaptureFolder) -> Response:
    """Append the body of a request to file ``number`` of a capture, from the offset ``at``.

    The answer has status 409 if the offset differs from the bytes received, or if another
    connection still sends this file. The page then asks how much there is, and goes on.

    Raises:
        UsageError: If the offset is no integer or the capture has no such file.
        LimitError: If the file exceeds its announced size.
    """
    offset = request.query_params.get("at", "0")
    if not offset.isdecimal() or len(offset) > 15:
        raise UsageError(f"at must be the number of bytes already uploaded, got {offset[:20]!r}")
    number = request.path_params["number"]
    try:
        held = await one.receive(number, int(offset), _body(request))
    except ConflictError as error:
        return JSONResponse({"error": explain_error(error)}, 409)
    except ClientDisconnect:  # What came stays.
        return Response(status_code=400)
    return JSONResponse({"held": held, "size": one.files[number].size})


def check_ready(workspace: Workspace, one: CaptureFolder) -> None:
    """Check that a job can start on a capture.

    Raises:
        UsageError: If files of the capture are missing.
        ConflictError: If a job on the capture is running.
    """
    if not one.complete:
        raise UsageError(f"{one.title!r} is incomplete; upload its files first")
    if workspace.job_of(one) is not None:
        raise ConflictError(one.title, "a job is running; wait for it or cancel it")


async def _body(request: Request) -> AsyncIterator[bytes]:
    """Iterate over a body, and end where nothing comes for long: the connection was lost."""
    stream = request.stream()
    while True:
        try:
            async with asyncio.timeout(MAX_SILENCE_S):
                chunk = await anext(stream, None)
        except TimeoutError as error:
            raise ClientDisconnect from error
        if chunk is None:
            return
        yield chunk
