"""The ``/api/exports``, ``/api/install`` and ``/api/build`` routes, which export a scene.

===============================  ==============================================================
GET  /api/exports                list formats, scales, styles, game versions, games and worlds
POST /api/exports                ``{form, blocks_per_metre, style, mc_version}``: start a job
GET  /api/exports/files/ID       download an exported file
POST /api/install                ``{game, name, ...}``: start a job; never overwrites a world
POST /api/games                  ``{folder}``: offer the installation in a folder -> ``{id}``
GET  /api/folders                ``?in=PATH``: list a folder, for the folder picker
POST /api/build/world            ``{world, at, turns, air, ...}``: start a job; ``w2m undo`` reverts
POST /api/build/server           ``{address, password, at, turns, air, ...}``: start a job
===============================  ==============================================================
"""

import asyncio
import re
import secrets
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Route

from world2minecraft.construction.parameters import STYLES
from world2minecraft.core.errors import UsageError
from world2minecraft.editing.build_into_world import check_air
from world2minecraft.minecraft.server.rcon import parse_address
from world2minecraft.minecraft.versions import DEFAULT_VERSION, game_versions
from world2minecraft.sceneforge import export_options as exports
from world2minecraft.sceneforge.game_folders import list_folder
from world2minecraft.sceneforge.jobs.jobs import JobFunction, JobProgress
from world2minecraft.sceneforge.jobs.subprocess_job import run_in_subprocess
from world2minecraft.sceneforge.server.local_address import is_loopback
from world2minecraft.sceneforge.server.request_parsing import get_workspace, read_json_object
from world2minecraft.sceneforge.server.start_routes import DEFAULT_SCALE, SCALES, check_choice
from world2minecraft.sceneforge.workspace import Workspace

CHOICES = ("blocks_per_metre", "style", "mc_version")
EXPORT_ID = re.compile(r"[0-9a-f]{16}")
MAX_COORDINATE = 30_000_000  # The world border of the game.
STAGE_SECONDS = {"build": 3.0, "write": 1.0}


def routes() -> list[BaseRoute]:
    """Return the routes for exports."""
    return [
        Route("/api/exports", _options),
        Route("/api/exports", _export, methods=["POST"]),
        Route("/api/exports/files/{id}", _file),
        Route("/api/install", _install, methods=["POST"]),
        Route("/api/games", _add_game, methods=["POST"]),
        Route("/api/folders", _folders),
        Route("/api/build/world", _into_world, methods=["POST"]),
        Route("/api/build/server", _on_server, methods=["POST"]),
    ]


async def _options(request: Request) -> Response:
    games = await asyncio.to_thread(get_workspace(request).game_folders.games)
    worlds = await asyncio.to_thread(exports.worlds_of, games.values())
    return JSONResponse(
        {
            "forms": [vars(one) for one in exports.export_forms()],
            "scales": list(SCALES),
            "scale": DEFAULT_SCALE,
            "styles": list(STYLES),
            "versions": [version.name for version in reversed(game_versions())],
            "version": DEFAULT_VERSION,
            "games": [
                {"id": key, "name": game.name, "version": game.version}
                for key, game in games.items()
            ],
            "worlds": [
                {"id": key, "name": folder.name, "game": game.name}
                for key, (game, folder) in worlds.items()
            ],
        }
    )


async def _export(request: Request) -> Response:
    workspace, body = get_workspace(request), await read_json_object(request)
    form = exports.get_export_form(str(body.pop("form", "")))
    choice = _choice(body)
    editor, number = workspace.editor, secrets.token_hex(8)
    target = workspace.exports / number

    def data(report: JobProgress) -> dict[str, Any]:
        target.mkdir(parents=True, exist_ok=True)
        path = exports.write_data(editor, form.id, target)
        return {"id": number, "file": path.name, "bytes": path.stat().st_size, "lost": []}

    def built(report: JobProgress) -> dict[str, Any]:
        with workspace.snapshot(editor) as folder:
            needs = {"form": form.id, "choice": choice, "target": str(target)}
            made = run_in_subprocess("export", folder, folder=str(folder), **needs)(report)
        return {"id": number} | made

    return _start_job(workspace, editor.name, built if form.built else data)


async def _file(request: Request) -> Response:
    number = request.path_params["id"]
    folder = get_workspace(request).exports / number
    made = [one for one in folder.iterdir() if one.is_file()] if _is_export(folder, number) else []
    if not made:
        raise UsageError(f"export {number[:40]!r} not found; export the scene again")
    return FileResponse(made[0], filename=made[0].name)


def _is_export(folder: Path, number: str) -> bool:
    return EXPORT_ID.fullmatch(number) is not None and folder.is_dir()


async def _install(request: Request) -> Response:
    workspace, body = get_workspace(request), await read_json_object(request)
    games = await asyncio.to_thread(workspace.game_folders.games)
    key, name = str(body.pop("game", "")), body.pop("name", "")
    if key not in games:
        raise UsageError("choose one of the listed Minecraft installations")
    if not isinstance(name, str) or len(name) > 100:
        raise UsageError("the world name must be a string of limited length")
    choice, game = _choice(body), games[key]
    place = [game.name, str(game.saves), game.version]
    return _start_subprocess_job(workspace, "install", choice=choice, game=place, name=name)


async def _add_game(request: Request) -> Response:
    require_this_machine(request)
    folder = (await read_json_object(request)).get("folder")
    if not isinstance(folder, str) or not folder:
        raise UsageError("folder must be the path of a game's folder")
    workspace = get_workspace(request)
    return JSONResponse({"id": await asyncio.to_thread(workspace.game_folders.add, folder)})


async def _folders(request: Request) -> Response:
    require_this_machine(request)
    return JSONResponse(await asyncio.to_thread(list_folder, request.query_params.get("in", "")))


def require_this_machine(request: Request) -> None:
    """Check that a request comes from a browser on this machine: folders are its user's.

    Raises:
        UsageError: If it comes from another machine.
    """
    if request.client is None or not is_loopback(request.client.host):
        raise UsageError("folders can be chosen only in a browser on the computer that runs w2m")


async def _into_world(request: Request) -> Response:
    workspace, body = get_workspace(request), await read_json_object(request)
    games = await asyncio.to_thread(workspace.game_folders.games)
    worlds = exports.worlds_of(games.values())
    key = str(body.pop("world", ""))
    if key not in worlds:
        raise UsageError("choose one of the listed worlds")
    place = parse_place(body)
    choice = _choice(body)
    return _start_subprocess_job(
        workspace, "into_world", choice=choice, world=str(worlds[key][1]), **place
    )


async def _on_server(request: Request) -> Response:
    workspace, body = get_workspace(request), await read_json_object(request)
    address, password = body.pop("address", ""), body.pop("password", "")
    if not isinstance(address, str) or not isinstance(password, str) or not password:
        raise UsageError("enter the server address and the RCON password")
    parse_address(address)
    place = parse_place(body)
    choice = _choice(body)
    needs = {"address": address, "password": password}
    return _start_subprocess_job(workspace, "on_server", choice=choice, **needs, **place)


def parse_place(body: dict[str, Any]) -> dict[str, Any]:
    """Remove ``at``, ``turns`` and ``air`` from a request body, check them and return them.

    Raises:
        UsageError: If a value is invalid. The message states the valid values.
    """
    at, turns, air = body.pop("at", None), body.pop("turns", 0), body.pop("air", "room")
    whole = isinstance(at, list) and len(at) == 3 and all(type(one) is int for one in at)
    if not whole or any(abs(one) > MAX_COORDINATE for one in at):
        raise UsageError(
            "at must be three integers x, y and z, as shown on the F3 screen of Minecraft"
        )
    if type(turns) is not int or not -3 <= turns <= 3:
        raise UsageError(f"turns must be -3 to 3 quarter turns, got {str(turns)[:20]!r}")
    check_air(str(air))
    return {"at": at, "turns": turns, "air": str(air)}


def _choice(body: dict[str, Any]) -> dict[str, Any]:
    if strange := sorted(body.keys() - set(CHOICES)):
        raise UsageError(f"unknown option {strange[0][:40]!r}; options: {', '.join(CHOICES)}")
    return check_choice(body)


def _start_subprocess_job(workspace: Workspace, task: str, **needs: Any) -> Response:
    editor = workspace.editor

    def work(report: JobProgress) -> Any:
        with workspace.snapshot(editor) as folder:
            return run_in_subprocess(task, folder, folder=str(folder), **needs)(report)

    return _start_job(workspace, editor.name, work)


def _start_job(workspace: Workspace, title: str, work: JobFunction) -> Response:
    return JSONResponse({"job": workspace.jobs.start(title, work, STAGE_SECONDS)})
