"""The phone page: a page of its own on the local network, with these routes and no others.

==============================================  ===============================================
GET    /, /phone.js, /phone.css                 the page
POST   /api/phone/pair                          ``{token}``: exchange a code for a cookie
GET    /api/phone                               limits, and the last capture of this phone
POST   /api/phone/captures                      ``{files: [{path, size}]}``: announce an upload
GET    /api/phone/captures/ID                   the capture: bytes received, its job, its room
PUT    /api/phone/captures/ID/files/N           ``?at=OFFSET``: upload the next bytes of a file
POST   /api/phone/captures/ID/build             start the job that makes the room
POST   /api/phone/captures/ID/cancel            cancel the job
GET    /api/phone/captures/ID/picture           an image of the room
GET    /api/phone/captures/ID/room              the room as one page
==============================================  ===============================================

A phone sees its own captures alone.
"""

import asyncio
from contextlib import suppress
from typing import Any

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response
from starlette.routing import Route

from world2minecraft.core.errors import InputError, LimitError, UnknownNameError, UsageError
from world2minecraft.rendering.mesh.viewer_page import ICON, STATIC
from world2minecraft.sceneforge.phone_access import (
    SESSION_LIFE_S,
    WRONG_WINDOW_S,
    Phone,
    PhoneAccess,
    TooManyTriesError,
    WrongCodeError,
)
from world2minecraft.sceneforge.phone_captures import (
    MAX_CAPTURES,
    MAX_PHOTOS,
    PHOTO_SUFFIXES,
    VIDEO_SUFFIXES,
    check_phone_files,
    phone_title,
    room_page_path,
    start_phone_room,
)
from world2minecraft.sceneforge.server.capture_requests import (
    check_ready,
    receive_part,
)
from world2minecraft.sceneforge.server.error_messages import EXCEPTION_HANDLERS
from world2minecraft.sceneforge.server.limits import BodyLimit
from world2minecraft.sceneforge.server.phone_guard import PAIR, PhoneGuard, cookie_name
from world2minecraft.sceneforge.server.request_parsing import get_workspace, read_json_object
from world2minecraft.sceneforge.uploads import CaptureFolder
from world2minecraft.sceneforge.workspace import Workspace

FRESH = {"cache-control": "no-cache"}
PHONE_CHUNK_BYTES = 1 << 20
MAX_BODY_BYTES = PHONE_CHUNK_BYTES + (64 << 10)
PAGE = f"""\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover">
<link rel="icon" href="{ICON}">
<link rel="stylesheet" href="phone.css">
<title>Scan a room</title>
</head>
<body>
<noscript>This page sends photos to your computer, for which it needs JavaScript.</noscript>
<main id="phone"></main>
<script src="phone.js"></script>
</body>
</html>
"""
# The room runs apart from the phone page, in an origin of its own, and reaches no server. Its own
# policy admits its script and style by their hashes.
ROOM_POLICY = (
    "sandbox allow-scripts allow-pointer-lock; default-src 'none'; img-src data: blob:; "
    "style-src 'unsafe-inline'; script-src 'unsafe-inline'; frame-ancestors 'none'"
)


def phone_app(access: PhoneAccess, workspace: Workspace) -> Starlette:
    """Return the application of the phone page, which serves nothing else."""
    one = "/api/phone/captures/{id}"
    app = Starlette(
        routes=[
            Route("/", _page),
            Route("/phone.js", _script),
            Route("/phone.css", _style),
            Route(PAIR, _pair, methods=["POST"]),
            Route("/api/phone", _overview),
            Route("/api/phone/captures", _announce, methods=["POST"]),
            Route(one, _capture),
            Route(one + "/files/{number:int}", _receive, methods=["PUT"]),
            Route(one + "/build", _build, methods=["POST"]),
            Route(one + "/cancel", _cancel, methods=["POST"]),
            Route(one + "/picture", _picture),
            Route(one + "/room", _room),
        ],
        middleware=[
            Middleware(PhoneGuard, access=access),
            Middleware(BodyLimit, json_bytes=MAX_BODY_BYTES, upload_bytes=MAX_BODY_BYTES),
        ],
        exception_handlers=EXCEPTION_HANDLERS,
    )
    app.state.workspace, app.state.access = workspace, access
    return app


async def _page(request: Request) -> Response:
    return HTMLResponse(PAGE)


async def _script(request: Request) -> Response:
    return FileResponse(STATIC / "phone.js", headers=FRESH)


async def _style(request: Request) -> Response:
    return FileResponse(STATIC / "phone.css", headers=FRESH)


async def _pair(request: Request) -> Response:
    access: PhoneAccess = request.app.state.access
    token = (await read_json_object(request)).get("token")
    sender = request.client.host if request.client else ""
    try:
        session = access.pair(token if isinstance(token, str) else "", sender)
    except TooManyTriesError as error:
        wait = {"Retry-After": str(round(WRONG_WINDOW_S))}
        return JSONResponse({"error": str(error)}, 429, wait)
    except WrongCodeError as error:
        return JSONResponse({"error": str(error)}, 403)
    answer = JSONResponse({})
    answer.set_cookie(
        cookie_name(access),
        session,
        max_age=round(SESSION_LIFE_S),
        httponly=True,
        samesite="strict",
        secure=access.url.startswith("https:"),
    )
    return answer


async def _overview(request: Request) -> Response:
    workspace, phone = get_workspace(request), _phone(request)
    last = _last_capture(workspace, phone)
    return JSONResponse(
        {
            "most_bytes": workspace.captures.max_bytes,
            "most_photos": MAX_PHOTOS,
            "photo_suffixes": list(PHOTO_SUFFIXES),
            "video_suffixes": list(VIDEO_SUFFIXES),
            "chunk_bytes": PHONE_CHUNK_BYTES,
            "capture": None if last is None else _capture_json(workspace, last),
        }
    )


async def _announce(request: Request) -> Response:
    workspace, phone = get_workspace(request), _phone(request)
    if len(phone.captures) >= MAX_CAPTURES:
        raise LimitError("this phone", f"sent {MAX_CAPTURES} captures; scan a new code for more")
    body = await read_json_object(request)
    files = check_phone_files(body.get("files"), workspace.captures.max_bytes)
    announced = [{"path": one.path, "size": one.size} for one in files]
    made = workspace.captures.create(phone_title(), announced)
    phone.captures.append(made.id)
    return JSONResponse({"id": made.id, "title": made.title, "files": announced})


async def _capture(request: Request) -> Response:
    return JSONResponse(_capture_json(get_workspace(request), _owned(request)))


async def _receive(request: Request) -> Response:
    return await receive_part(request, _owned(request))


async def _build(request: Request) -> Response:
    workspace, one = get_workspace(request), _owned(request)
    check_ready(workspace, one)
    return JSONResponse({"job": start_phone_room(workspace, one)})


async def _cancel(request: Request) -> Response:
    workspace, one = get_workspace(request), _owned(request)
    number = workspace.job_of(one)
    if number is not None:
        await asyncio.to_thread(workspace.jobs.cancel, number)  # A process has its time.
    return JSONResponse({})


async def _picture(request: Request) -> Response:
    path = _owned(request).run / "preview.png"
    if not path.is_file():
        raise UsageError("this room has no picture yet; build the room first")
    return FileResponse(path)


async def _room(request: Request) -> Response:
    path = room_page_path(_owned(request))
    if not path.is_file():
        raise UsageError("there is no room yet; build the room first")
    return FileResponse(path, headers={"content-security-policy": ROOM_POLICY})


def _capture_json(workspace: Workspace, one: CaptureFolder) -> dict[str, Any]:
    number = workspace.running_jobs.get(one.id)
    job = None
    if number is not None:
        try:
            job = workspace.jobs.state(number).message()
        except UnknownNameError:
            job = None  # It ended long ago.
    return {
        "id": one.id,
        "title": one.title,
        "files": len(one.files),
        "bytes": sum(file.size for file in one.files),
        "held": one.received_bytes(),
        "complete": one.complete,
        "has_room": one.has_room,
        "has_page": room_page_path(one).is_file(),
        "job": job,
    }


def _last_capture(workspace: Workspace, phone: Phone) -> CaptureFolder | None:
    """Return the last capture of a phone that was not deleted on the computer."""
    for number in reversed(phone.captures):
        try:
            return workspace.captures.named(number)
        except UsageError:
            continue
    return None


def _phone(request: Request) -> Phone:
    return request.scope["phone"]


def _owned(request: Request) -> CaptureFolder:
    """Return the capture of a request.

    Raises:
        InputError: If this phone did not send it, or it was deleted on the computer.
    """
    number = request.path_params["id"]
    if number in _phone(request).captures:
        with suppress(UnknownNameError):  # Its message would list the captures of others.
            return get_workspace(request).captures.named(number)
    raise InputError("this capture", "not found on the computer; scan the room again")
