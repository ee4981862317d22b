"""The HTTP routes of the annotation page, protected by the SceneForge guard."""

from pathlib import Path

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge.annotation.store import AnnotationStore
from world2minecraft.sceneforge.server.error_messages import EXCEPTION_HANDLERS
from world2minecraft.sceneforge.server.guard import Guard
from world2minecraft.sceneforge.server.limits import BodyLimit
from world2minecraft.sceneforge.server.request_parsing import read_json_object
from world2minecraft.sceneforge.server.server_process import PageServer

PAGE = Path(__file__).parent / "page"
MAX_BODY = 64 << 10


def annotation_server(desk: AnnotationStore, port: int | None = None) -> PageServer:
    """Return a server for an annotation store that listens on loopback and requires its link."""
    return PageServer(lambda token, port: build_app(desk, token, port), port=port)


def build_app(desk: AnnotationStore, token: str, port: int) -> Starlette:
    """Return the web application that serves an annotation store."""
    app = Starlette(
        routes=[
            Route("/api/walks", _walks),
            Route("/api/walk/{number:int}", _walk),
            Route("/api/image/{number:int}/{frame:int}", _image),
            Route("/api/check", _check, methods=["POST"]),
            Route("/api/add", _add, methods=["POST"]),
            Mount("/", StaticFiles(directory=PAGE, html=True)),
        ],
        middleware=[
            Middleware(Guard, token=token, port=port),
            Middleware(BodyLimit, json_bytes=MAX_BODY, upload_bytes=0),
        ],
        exception_handlers=EXCEPTION_HANDLERS,
    )
    app.state.desk = desk
    return app


def _desk(request: Request) -> AnnotationStore:
    return request.app.state.desk


def _walks(request: Request) -> Response:
    return JSONResponse({"walks": _desk(request).listed(), "file": str(_desk(request).out)})


def _walk(request: Request) -> Response:
    return JSONResponse(_desk(request).walk(request.path_params["number"]))


def _image(request: Request) -> Response:
    params = request.path_params
    data, kind = _desk(request).image(params["number"], params["frame"])
    return Response(data, media_type=kind)


async def _check(request: Request) -> Response:
    number, level, text = await _fields(request, "level", "text")
    return JSONResponse({"findings": _desk(request).check(number, level, text)})


async def _add(request: Request) -> Response:
    number, *texts = await _fields(request, "level", "text", "annotator", "language")
    level, text, annotator, language = texts
    return JSONResponse(_desk(request).add(number, level, text, annotator, language))


async def _fields(request: Request, *names: str) -> tuple:
    fields = await read_json_object(request)
    number, texts = fields.get("number"), [fields.get(name) for name in names]
    if not isinstance(number, int) or not all(isinstance(text, str) for text in texts):
        raise UsageError(
            f"the body must contain an integer number and the strings {', '.join(names)}"
        )
    return (number, *texts)
