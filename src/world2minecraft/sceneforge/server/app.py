"""The web application: a page, a small HTTP API and a websocket, all protected by the guard."""

import asyncio
from collections.abc import Iterable
from pathlib import Path

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles

from world2minecraft.editing.scene import COMMANDS
from world2minecraft.sceneforge.agent_walks import WalkAgents, WalkingModels
from world2minecraft.sceneforge.queries import QUERIES
from world2minecraft.sceneforge.server import (
    agent_routes,
    compare_routes,
    export_routes,
    photo_routes,
)
from world2minecraft.sceneforge.server import start_routes as start
from world2minecraft.sceneforge.server.build_preview_routes import build_routes
from world2minecraft.sceneforge.server.error_messages import EXCEPTION_HANDLERS
from world2minecraft.sceneforge.server.guard import Guard
from world2minecraft.sceneforge.server.limits import BodyLimit
from world2minecraft.sceneforge.server.request_parsing import read_json_object
from world2minecraft.sceneforge.server.websocket import live
from world2minecraft.sceneforge.session import NO_ROOM, Session
from world2minecraft.sceneforge.workspace import Workspace

STATIC = Path(__file__).parents[1] / "static"


def build_app(
    session: Session,
    *,
    workspace: Workspace | None = None,
    token: str,
    port: int,
    hosts: Iterable[str] = (),
    any_address: bool = False,
    in_notebook: bool = False,
    agents: WalkAgents | None = None,
) -> Starlette:
    """Return the application that serves a session. See ``Guard`` for the arguments.

    ``agents`` are the models that may walk in the room; None lets none walk.
    """
    guard = Middleware(
        Guard,
        token=token,
        port=port,
        hosts=hosts,
        any_address=any_address,
        in_notebook=in_notebook,
    )
    app = Starlette(
        routes=[
            *routes(),
            *start.routes(),
            *photo_routes.routes(),
            *compare_routes.routes(),
            *export_routes.routes(),
            *agent_routes.routes(),
            Mount("/", StaticFiles(directory=STATIC, html=True)),
        ],
        middleware=[guard, Middleware(BodyLimit)],
        exception_handlers=EXCEPTION_HANDLERS,
    )
    app.state.session, app.state.workspace = session, workspace
    app.state.agent_turns = agent_routes.AgentTurns(WalkingModels(agents or WalkAgents()))
    return app


def routes() -> list[BaseRoute]:
    """Return all routes under ``/api/``."""
    return [
        Route("/api/scene", _scene),
        Route("/api/volume", _volume),
        Route("/api/do", _do, methods=["POST"]),
        Route("/api/undo", _undo, methods=["POST"]),
        Route("/api/redo", _redo, methods=["POST"]),
        Route("/api/save", _save, methods=["POST"]),
        Route("/api/preview", _preview, methods=["POST"]),
        Route("/api/ask/{name}", _ask, methods=["POST"]),
        Route("/api/commands", _commands),
        *build_routes(),
        WebSocketRoute("/api/live", live),
    ]


def session_of(request: Request) -> Session:
    """Return the session of the server that received a request."""
    return request.app.state.session


async def _scene(request: Request) -> Response:
    session, workspace = session_of(request), request.app.state.workspace
    if session.editor is None:
        return JSONResponse({"error": NO_ROOM}, 404)
    if workspace is not None:
        session.editor.has = await asyncio.to_thread(workspace.extras)
    return JSONResponse(await session.scene())


async def _volume(request: Request) -> Response:
    zipped = "gzip" in request.headers.get("accept-encoding", "")
    what = request.query_params.get("what", "labels")
    rev, data = await session_of(request).volume(what, zipped)
    headers = {"X-Rev": str(rev), "Vary": "Accept-Encoding"}
    if zipped:
        headers["Content-Encoding"] = "gzip"
    return Response(data, headers=headers, media_type="application/octet-stream")


async def _do(request: Request) -> Response:
    return JSONResponse(await session_of(request).do(await read_json_object(request), "script"))


async def _undo(request: Request) -> Response:
    return JSONResponse(await session_of(request).undo())


async def _redo(request: Request) -> Response:
    return JSONResponse(await session_of(request).redo())


async def _save(request: Request) -> Response:
    return JSONResponse({"rev": await session_of(request).save()})


async def _preview(request: Request) -> Response:
    return JSONResponse(await session_of(request).preview(await read_json_object(request)))


async def _ask(request: Request) -> Response:
    fields = await read_json_object(request)
    return JSONResponse(await session_of(request).ask(request.path_params["name"], fields))


async def _commands(request: Request) -> Response:
    kinds = {"commands": COMMANDS, "queries": QUERIES}
    schemas = {
        what: {name: kind.model_json_schema() for name, kind in known.items()}
        for what, known in kinds.items()
    }
    return JSONResponse(schemas)
