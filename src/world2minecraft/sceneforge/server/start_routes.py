"""The ``/api/start`` routes, which turn a capture or a demo into a room that is open in the editor.

=========================================  ====================================================
GET    /api/start                          list the captures, recent rooms and options
POST   /api/start/captures                 ``{title, files: [{path, size}]}``: announce an upload
PUT    /api/start/captures/ID/files/N      ``?at=OFFSET``: upload the next bytes of a file
POST   /api/start/captures/ID/look         start a job that surveys the capture
GET    /api/start/captures/ID              return the capture and its survey
GET    /api/start/captures/ID/picture.png  return the image that ``w2m scan`` draws
GET    /api/start/rooms/ID/picture         return an image of a capture's room, of a recent room
                                           ``recent-N`` or of the ``example``
POST   /api/start/captures/ID/reconstruct  ``{blocks_per_metre, style, known}``: start a job
DELETE /api/start/captures/ID              delete the capture and its room
GET    /api/start/rooms/ID/report          return the report of a room
POST   /api/start/rooms/ID/share           start a job that writes the room as one page, which
                                           ``/api/exports/files`` returns
POST   /api/start/rooms/ID/install         ``{game}``: start a job that copies its world into a game
POST   /api/start/demo                     ``{kind, seed}``: start a job that generates a room, or
                                           return the running job with the same parameters
GET    /api/start/phone                    return the code of the phone page (``w2m forge --phone``)
POST   /api/start/phone                    make a new code
POST   /api/start/open                     ``{id}``: open a room in the editor
POST   /api/start/close                    close the room and return to the start page
GET    /api/start/jobs/ID/layers           list what the reconstruction of a job has found so far
GET    /api/start/jobs/ID/layers/LAYER     return a layer, as in ``live_layers``
GET    /api/jobs                           list all jobs; POST /api/jobs/ID/cancel cancels one
=========================================  ====================================================
"""

import asyncio
import secrets
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Route

from world2minecraft.capture.scale.known_lengths import LENGTHS_M
from world2minecraft.construction.parameters import STYLES
from world2minecraft.core.errors import ConflictError, InputError, UsageError
from world2minecraft.minecraft.worlds.installation import age_note, install_world
from world2minecraft.procgen import BASE_KINDS
from world2minecraft.procgen.rooms.recipes import room_title
from world2minecraft.sceneforge.document.document_metadata import SUFFIX
from world2minecraft.sceneforge.jobs.jobs import JobProgress, JobState
from world2minecraft.sceneforge.jobs.reconstruct_tasks import parameters_of_choice
from world2minecraft.sceneforge.jobs.subprocess_job import run_in_subprocess
from world2minecraft.sceneforge.jobs.time_left import demo_stage_seconds, reconstruct_stage_seconds
from world2minecraft.sceneforge.live_layers import finished_layers, layer_bytes
from world2minecraft.sceneforge.phone_access import PhoneAccess, qr_svg_uri
from world2minecraft.sceneforge.scene_sources import DEMO_FOLDER, DEMO_PICTURE
from world2minecraft.sceneforge.server.capture_requests import (
    CHUNK_BYTES,
    check_ready,
    receive_part,
)
from world2minecraft.sceneforge.server.request_parsing import get_workspace, read_json_object
from world2minecraft.sceneforge.uploads import PICTURE, CaptureFolder
from world2minecraft.sceneforge.workspace import Workspace

SCALES = (1, 2, 4, 12.5)
DEFAULT_SCALE = 4
EXAMPLE = "example"  # The id of the demo room, which is finished.
ROOM_PICTURE = "preview.png"
# A report is a page of its own, from a folder that anyone may have written: it runs apart from the
# editor, in an origin of its own, and reaches no server.
REPORT_POLICY = (
    "sandbox allow-scripts; default-src 'none'; img-src data: blob:; "
    "style-src 'unsafe-inline'; script-src 'unsafe-inline'"
)


def routes() -> list[BaseRoute]:
    """Return the routes of the start page."""
    one = "/api/start/captures/{id}"
    return [
        Route("/api/start", _overview),
        Route("/api/start/captures", _announce, methods=["POST"]),
        Route(one + "/files/{number:int}", _receive, methods=["PUT"]),
        Route(one + "/look", _survey, methods=["POST"]),
        Route(one, _capture),
        Route(one, _forget, methods=["DELETE"]),
        Route(one + "/picture.png", _picture),
        Route("/api/start/rooms/{id}/picture", _room_picture),
        Route(one + "/reconstruct", _reconstruct, methods=["POST"]),
        Route("/api/start/rooms/{id}/report", _room_report),
        Route("/api/start/rooms/{id}/share", _share_room, methods=["POST"]),
        Route("/api/start/rooms/{id}/install", _install_room, methods=["POST"]),
        Route("/api/start/demo", _demo, methods=["POST"]),
        Route("/api/start/phone", _phone),
        Route("/api/start/phone", _new_phone_code, methods=["POST"]),
        Route("/api/start/open", _open, methods=["POST"]),
        Route("/api/start/close", _close, methods=["POST"]),
        Route("/api/start/jobs/{id}/layers", _layers),
        Route("/api/start/jobs/{id}/layers/{layer}", _layer),
        Route("/api/jobs", _jobs),
        Route("/api/jobs/{id}/cancel", _cancel, methods=["POST"]),
    ]


async def _overview(request: Request) -> Response:
    workspace = get_workspace(request)
    known = {name: list(limits) for name, limits in LENGTHS_M.items() if name != "distance"}
    return JSONResponse(
        {
            "home": str(workspace.home),
            "captures": [_capture_json(workspace, one) for one in workspace.captures.all()],
            "recent": [
                {
                    "id": f"recent-{n}",
                    "name": place.name.removesuffix(SUFFIX),
                    "folder": str(place.parent),
                    "has_picture": (place / ROOM_PICTURE).is_file(),
                }
                for n, place in enumerate(workspace.recent())
            ],
            "demos": list(BASE_KINDS),
            "most_bytes": workspace.captures.max_bytes,
            "chunk_bytes": CHUNK_BYTES,
            "scales": list(SCALES),
            "scale": DEFAULT_SCALE,
            "styles": list(STYLES),
            "known": known,
            "phone": workspace.phone and _phone_json(workspace, workspace.phone),
            "wanted": workspace.wanted,
        }
    )


def _capture_json(workspace: Workspace, one: CaptureFolder) -> dict[str, Any]:
    complete = one.complete
    return {
        "id": one.id,
        "title": one.title,
        "files": len(one.files),
        "bytes": sum(file.size for file in one.files),
        "elsewhere": "" if one.files else str(one.source),
        "complete": complete,
        "has_room": one.has_room,
        "job": workspace.job_of(one),
        "survey": one.survey() if complete else None,
    }


async def _announce(request: Request) -> Response:
    body = await read_json_object(request)
    title = body.get("title") if isinstance(body.get("title"), str) else ""
    made = get_workspace(request).captures.create(str(title), body.get("files"))
    files = [{"path": one.path, "size": one.size} for one in made.files]
    return JSONResponse({"id": made.id, "title": made.title, "files": files})


async def _receive(request: Request) -> Response:
    return await receive_part(request, _named(request))


async def _capture(request: Request) -> Response:
    workspace, one = get_workspace(request), _named(request)
    return JSONResponse(_capture_json(workspace, one) | {"held": one.received_bytes()})


async def _forget(request: Request) -> Response:
    workspace, one = get_workspace(request), _named(request)
    opened = getattr(getattr(workspace.session.editor, "opened", None), "folder", None)
    if opened is not None and Path(opened).resolve() == one.run.resolve():
        raise ConflictError(
            one.title, "the room of this capture is open in the editor; close it first"
        )
    number = workspace.job_of(one)
    await asyncio.to_thread(_delete_capture, workspace, one.id, number)
    return JSONResponse({})


def _delete_capture(workspace: Workspace, capture: str, job: str | None) -> None:
    """End the job on a capture and delete the capture. This may take seconds."""
    if job is not None:
        workspace.jobs.cancel(job)
        workspace.jobs.wait(job, 10)
    workspace.captures.delete(capture)


async def _survey(request: Request) -> Response:
    workspace, one = get_workspace(request), _named(request)
    check_ready(workspace, one)
    work = run_in_subprocess(
        "survey", one.source.parent, capture=str(one.source), folder=str(one.folder)
    )
    number = workspace.jobs.start(one.title, work, {"look": 4.0})
    workspace.note_job(number, one.id, one.run)
    return JSONResponse({"job": number})


async def _reconstruct(request: Request) -> Response:
    workspace, one = get_workspace(request), _named(request)
    choice = check_choice(await read_json_object(request))
    check_ready(workspace, one)
    work = run_in_subprocess(
        "reconstruct", one.source.parent, capture=str(one.source), out=str(one.run), choice=choice
    )
    number = workspace.jobs.start(one.title, work, reconstruct_stage_seconds(one.survey()))
    workspace.note_job(number, one.id, one.run)
    return JSONResponse({"job": number})


def check_choice(body: dict[str, Any]) -> dict[str, Any]:
    """Check the options that a user chose for a reconstruction, and return them unchanged.

    Raises:
        UsageError: If an option is unknown or its value is invalid. The message lists the valid
            values.
    """
    known = ("blocks_per_metre", "style", "known", "mc_version", "voxel_m")
    if strange := sorted(body.keys() - set(known)):
        raise UsageError(f"unknown option {strange[0][:40]!r}; options: {', '.join(known)}")
    try:
        parameters_of_choice(body)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"an option has the wrong type: {error}") from error
    return body


async def _demo(request: Request) -> Response:
    workspace, body = get_workspace(request), await read_json_object(request)
    kind, seed = body.get("kind", BASE_KINDS[0]), body.get("seed", 5)
    if kind not in BASE_KINDS:
        raise UsageError(f"kind must be one of {', '.join(BASE_KINDS)}, got {str(kind)[:40]!r}")
    if not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed < 1 << 31:
        raise UsageError(f"seed must be an integer from 0 to 2147483647, got {str(seed)[:40]!r}")
    frames = body.get("frames", 40)
    if not isinstance(frames, int) or not 3 <= frames <= 200:
        raise UsageError(f"frames must be an integer from 3 to 200, got {str(frames)[:40]!r}")
    name, title = f"demo/{kind}-{seed}", room_title(kind)
    if (running := workspace.job_at(name)) is not None:
        return JSONResponse({"job": running})  # Whoever asks again sees how far it is.
    out = workspace.home / name
    work = run_in_subprocess("demo", out=str(out), kind=kind, seed=seed, frames=frames)
    number = workspace.jobs.start(title, work, demo_stage_seconds(), _remember(workspace))
    workspace.note_job(number, name, out)
    return JSONResponse({"job": number})


def _remember(workspace: Workspace) -> Any:
    def ended(state: JobState) -> None:
        workspace.add_recent(Path(state.result["out"]))

    return ended


async def _phone(request: Request) -> Response:
    return JSONResponse(_phone_json(get_workspace(request), _phone_access(request)))


async def _new_phone_code(request: Request) -> Response:
    access = _phone_access(request)
    access.new_code()
    return JSONResponse(_phone_json(get_workspace(request), access))


def _phone_access(request: Request) -> PhoneAccess:
    access = get_workspace(request).phone
    if access is None:
        raise UsageError("this server has no phone page; run w2m forge --phone")
    return access


def _phone_json(workspace: Workspace, access: PhoneAccess) -> dict[str, Any]:
    """Return the current code as a link and a picture, and the state of what phones have sent."""
    link, sent = access.link, {number for one in access.phones for number in one.captures}
    return {
        "link": link,
        "code": qr_svg_uri(link) if link else "",
        "left_s": round(access.left_s),
        "phones": len(access.phones),
        "captures": [
            [one.id, one.complete, workspace.job_of(one) is not None, one.has_room]
            for one in (workspace.captures.all() if sent else ())
            if one.id in sent
        ],
    }


async def _open(request: Request) -> Response:
    workspace, number = get_workspace(request), (await read_json_object(request)).get("id")
    if number == EXAMPLE:
        await workspace.open_example()
    else:
        await workspace.open(workspace.room_named(str(number)))
    return JSONResponse({"name": workspace.editor.name})


async def _close(request: Request) -> Response:
    await get_workspace(request).session.show(None)
    return JSONResponse({})


async def _picture(request: Request) -> Response:
    return _file(_named(request).folder / PICTURE)


async def _room_picture(request: Request) -> Response:
    number = request.path_params["id"]
    if number == EXAMPLE:
        return _file(DEMO_FOLDER / DEMO_PICTURE)
    return _file(get_workspace(request).room_named(number) / ROOM_PICTURE)


async def _room_report(request: Request) -> Response:
    place = get_workspace(request).room_named(request.path_params["id"]) / "report.html"
    return _file(place, {"content-security-policy": REPORT_POLICY})


async def _share_room(request: Request) -> Response:
    workspace = get_workspace(request)
    body, number = await read_json_object(request), secrets.token_hex(8)
    room, target = workspace.room_named(request.path_params["id"]), workspace.exports / number
    title = str(body.get("title") or room.name)[:100]
    work = run_in_subprocess("share", room, room=str(room), title=title, target=str(target))

    def shared(report: JobProgress) -> dict[str, Any]:
        return {"id": number} | work(report)

    return JSONResponse({"job": workspace.jobs.start(title, shared, {"share": 4.0})})


async def _install_room(request: Request) -> Response:
    workspace, body = get_workspace(request), await read_json_object(request)
    room = workspace.room_named(request.path_params["id"])
    games = await asyncio.to_thread(workspace.game_folders.games)
    game = games.get(str(body.get("game", "")))
    if game is None:
        raise UsageError("choose one of the listed Minecraft installations")

    def install(report: JobProgress) -> dict[str, str]:
        report("install", 0, 1)
        target = install_world(room / "build" / "world", game.saves)
        report("install", 1, 1)
        return {"name": target.name, "game": game.name, "note": age_note(target, game)}

    return JSONResponse({"job": workspace.jobs.start(room.name, install, {"install": 1.0})})


def _file(path: Path, headers: dict[str, str] | None = None) -> Response:
    if not path.is_file():
        raise InputError(path.name, "file not found; create the room first")
    return FileResponse(path, headers=headers)


async def _layers(request: Request) -> Response:
    begun = get_workspace(request).run_of_job(request.path_params["id"])
    return JSONResponse(await asyncio.to_thread(finished_layers, begun.run, begun.since_s))


async def _layer(request: Request) -> Response:
    begun = get_workspace(request).run_of_job(request.path_params["id"])
    data = await asyncio.to_thread(layer_bytes, begun.run, request.path_params["layer"])
    return Response(data, media_type="application/octet-stream")


async def _jobs(request: Request) -> Response:
    return JSONResponse(get_workspace(request).jobs.states())


async def _cancel(request: Request) -> Response:
    number = request.path_params["id"]
    await asyncio.to_thread(get_workspace(request).jobs.cancel, number)  # A process has its time.
    return JSONResponse({})


def _named(request: Request) -> CaptureFolder:
    return get_workspace(request).captures.named(request.path_params["id"])
