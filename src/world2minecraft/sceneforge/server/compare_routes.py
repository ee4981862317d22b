"""The ``/api/compare`` routes, which compare the document with another occupancy of its room.

====================================  ========================================================
GET    /api/compare                   ``{name, has_truth, beyond}``: name of the open comparison,
                                      if any, and its cells outside the document by class
POST   /api/compare/truth             compare with the ground truth of a generated room
POST   /api/compare/opened            compare with the scene as it was first opened
POST   /api/upload/compare?name=NAME  compare with an uploaded room.npz, occ.json, .npz or .npy
GET    /api/compare/labels            labels of the comparison in the document's cells (``W2MV``)
DELETE /api/compare                   end the comparison
====================================  ========================================================
"""

import asyncio
import tempfile
from pathlib import Path

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from world2minecraft.core.errors import UsageError, World2MinecraftError
from world2minecraft.sceneforge.array_messages import labels_bytes
from world2minecraft.sceneforge.comparison import (
    Reference,
    check_suffix,
    read_file_labels,
    read_truth,
)
from world2minecraft.sceneforge.server.request_parsing import get_workspace
from world2minecraft.sceneforge.workspace import Comparison, Workspace


def routes() -> list[BaseRoute]:
    """Return the routes for comparisons."""
    return [
        Route("/api/compare", _status),
        Route("/api/compare", _end, methods=["DELETE"]),
        Route("/api/compare/truth", _truth, methods=["POST"]),
        Route("/api/compare/opened", _opened, methods=["POST"]),
        Route("/api/compare/labels", _labels),
        Route("/api/upload/compare", _file, methods=["POST"]),
    ]


async def _status(request: Request) -> Response:
    return _answer(get_workspace(request))


async def _end(request: Request) -> Response:
    workspace = get_workspace(request)
    workspace.compared = None
    return _answer(workspace)


async def _truth(request: Request) -> Response:
    workspace = get_workspace(request)
    folder = workspace.truth_folder()
    if folder is None:
        raise UsageError("this room has no ground truth; only generated rooms have one")
    editor = workspace.editor
    scan_to_room = editor.opened.scan_to_room
    reference = await asyncio.to_thread(
        read_truth, workspace.run, folder, editor.draft, scan_to_room
    )
    workspace.compared = Comparison("truth", reference, editor)
    return _answer(workspace)


async def _opened(request: Request) -> Response:
    workspace = get_workspace(request)
    reference = Reference(workspace.editor.opened.grid.labels)
    workspace.compared = Comparison("opened", reference, workspace.editor)
    return _answer(workspace)


async def _file(request: Request) -> Response:
    workspace = get_workspace(request)
    editor, name = workspace.editor, request.query_params.get("name", "")
    suffix = check_suffix(name)
    with tempfile.TemporaryDirectory(prefix="w2m-") as scratch:
        # The file's own name tells ours from others: room.npz, occ.json.
        place = Path(scratch) / f"{'occ' if suffix == '.json' else 'compared'}{suffix}"
        with place.open("wb") as stream:
            async for chunk in request.stream():
                stream.write(chunk)
        try:
            labels = await asyncio.to_thread(read_file_labels, place, editor.draft)
        except World2MinecraftError as error:
            message = str(error).replace(str(place), Path(name).name[:80])
            raise UsageError(message) from error
    workspace.compared = Comparison(Path(name).name[:80], Reference(labels), editor)
    return _answer(workspace)


async def _labels(request: Request) -> Response:
    workspace = get_workspace(request)
    if workspace.compared is None or workspace.compared.editor is not workspace.session.editor:
        raise UsageError("no comparison is open; choose a file or the ground truth first")
    data = labels_bytes(workspace.editor.draft, workspace.compared.reference.labels)
    return Response(data, media_type="application/octet-stream", headers={"X-Rev": "0"})


def _answer(workspace: Workspace) -> Response:
    compared = workspace.compared
    is_here = compared is not None and compared.editor is workspace.session.editor
    return JSONResponse(
        {
            "name": compared.name if compared is not None and is_here else "",
            "has_truth": workspace.truth_folder() is not None,
            "beyond": compared.reference.beyond.tolist()
            if compared is not None and is_here
            else [],
        }
    )
