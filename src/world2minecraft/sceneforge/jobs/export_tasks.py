"""The worker tasks that export the edited scene: files, worlds in the game, and builds on a server.

Each task accepts a folder with ``room.npz``, ``objects.json`` and ``placements.json`` (see
``write_snapshot``) and JSON values, and returns JSON values.
"""

import shutil
import tempfile
from pathlib import Path
from typing import Any

from PIL import Image

from world2minecraft.construction import WORLD_NAME, write_build
from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
from world2minecraft.core.files import write_bytes
from world2minecraft.core.progress import Progress
from world2minecraft.core.types import BlockVolume
from world2minecraft.editing.build_into_world import affected_mask, build_into_world
from world2minecraft.editing.volume_relocation import place_volume
from world2minecraft.formats.object_names import read_run_names
from world2minecraft.formats.volume_formats import format_by_name, run_details, write_volume
from world2minecraft.minecraft.commands.player_scale import size_pack
from world2minecraft.minecraft.file_format import Losses, WriteOptions
from world2minecraft.minecraft.server.rcon import RconClient, build_note_path, parse_address
from world2minecraft.minecraft.server.server_build import LiveBuilder, plan_build
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.installation import age_note, install_world
from world2minecraft.minecraft.worlds.launchers import Game
from world2minecraft.reconstruction.file_stages import built_volume, scene_name
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.rendering.preview import preview
from world2minecraft.sceneforge.jobs.reconstruct_tasks import parameters_of_choice
from world2minecraft.sceneforge.share.page import room_page
from world2minecraft.sceneforge.share.room_data import SharedRoom

WORLD, PICTURE = "world", "png"
SHARED = "room.html"


def export(
    folder: str, form: str, target: str, choice: dict[str, Any], progress: Progress
) -> dict[str, Any]:
    """Write a scene in one format into the folder ``target``.

    Args:
        folder: Folder with the scene.
        form: Format: a name of ``formats.volume_formats``, ``world`` or ``png``.
        target: Folder for the exported file.
        choice: Options, as for ``reconstruct_tasks.parameters_of_choice``.
        progress: Callback for the progress of building and writing.

    Returns:
        A dict with ``file``, the file name; ``bytes``, its size; and ``lost`` [[description,
        count]], the content that the format cannot represent.
    """
    chosen, losses = parameters_of_choice(choice), Losses()
    volume = _blocks(Path(folder), chosen, progress)
    progress("write", 0, 1)
    path = _written(volume, Path(folder), form, Path(target), chosen, losses)
    progress("write", 1, 1)
    lost = [[what, count] for what, count in losses]
    return {"file": path.name, "bytes": path.stat().st_size, "lost": lost}


def _written(
    volume: BlockVolume,
    folder: Path,
    form: str,
    target: Path,
    chosen: Parameters,
    losses: Losses,
) -> Path:
    target.mkdir(parents=True, exist_ok=True)
    if form == PICTURE:
        Image.fromarray(preview(volume)).save(target / "room.png")
        return target / "room.png"
    if form == WORLD:
        name = scene_name(folder) or WORLD_NAME
        names = read_run_names(folder)
        write_build(
            target / "build", volume, mc_version=chosen.mc_version, name=name, objects=names
        )
        return _zipped(target / "build" / "world", target / "room_world.zip")
    path = target / f"room{format_by_name(form).suffix}"
    options = WriteOptions(mc_version=chosen.mc_version, other=run_details(folder))
    write_volume(volume, path, options, losses)
    return _zipped(path, target / f"room_{form}.zip") if path.is_dir() else path


def _zipped(folder: Path, path: Path) -> Path:
    shutil.make_archive(str(path.with_suffix("")), "zip", folder.parent, folder.name)
    shutil.rmtree(folder)
    return path


def share(room: str, title: str, target: str, progress: Progress) -> dict[str, Any]:
    """Write a finished run as one page into the folder ``target``, without photos.

    Returns:
        A dict with ``file``, the file name, and ``bytes``, its size.
    """
    progress("share", 0, 1)
    page, _ = room_page(SharedRoom.read(Path(room), title), 0, None, progress)
    Path(target).mkdir(parents=True, exist_ok=True)
    write_bytes(Path(target) / SHARED, page)
    progress("share", 1, 1)
    return {"file": SHARED, "bytes": len(page)}


def install(
    folder: str, choice: dict[str, Any], game: list[str | None], name: str, progress: Progress
) -> dict[str, Any]:
    """Build the world and copy it into a Minecraft installation without overwriting any world.

    Args:
        folder: Folder with the scene.
        choice: Options, as for ``reconstruct_tasks.parameters_of_choice``.
        game: Name, saves folder and version (or None) of the installation.
        name: Name of the world. An empty name uses the name of the scene.
        progress: Callback for the progress of each step.
    """
    chosen = parameters_of_choice(choice)
    into = Game(str(game[0]), Path(str(game[1])), game[2])
    volume = _blocks(Path(folder), chosen, progress)
    progress("install", 0, 1)
    title = name or scene_name(Path(folder)) or WORLD_NAME
    with tempfile.TemporaryDirectory(prefix="w2m-") as scratch:
        write_build(scratch, volume, mc_version=chosen.mc_version, name=title)
        target = install_world(Path(scratch) / "world", into.saves, title)
        note = age_note(target, into)
    progress("install", 1, 1)
    return {"name": target.name, "game": into.name, "note": note}


def into_world(
    folder: str,
    choice: dict[str, Any],
    world: str,
    at: list[int],
    turns: int,
    air: str,
    progress: Progress,
) -> dict[str, Any]:
    """Build the scene into an existing world, as ``w2m build --into`` does, after backing it up."""
    chosen = parameters_of_choice(choice)
    volume = _blocks(Path(folder), chosen, progress)
    progress("write", 0, 1)
    put = place_volume(volume, (at[0], at[1], at[2]), turns, ROOM_CORNER_BLOCK[1])
    pack = {"datapacks/player_size.zip": size_pack(volume.blocks_per_metre)}
    done = build_into_world(
        Path(world),
        put,
        air=air,
        extra=pack if volume.blocks_per_metre != 1 else None,
        what=f"built at {at[0]} {at[1]} {at[2]}",
    )
    progress("write", 1, 1)
    return {"blocks": done.blocks, "entities": done.entities, "changed": done.step is not None}


def on_server(
    folder: str,
    choice: dict[str, Any],
    address: str,
    password: str,
    at: list[int],
    turns: int,
    air: str,
    progress: Progress,
) -> dict[str, Any]:
    """Build the scene on a running server, as ``w2m build --rcon`` does. This cannot be undone."""
    chosen = parameters_of_choice(choice)
    host, port = parse_address(address)
    volume = _blocks(Path(folder), chosen, progress)
    put = place_volume(volume, (at[0], at[1], at[2]), turns, ROOM_CORNER_BLOCK[1])
    losses = Losses()
    version = game_version(chosen.mc_version)
    plan = plan_build(put, version, built=affected_mask(put, air), losses=losses)
    client = RconClient(host, port, password)
    result = LiveBuilder(
        client, plan, build_note_path(f"{host}:{port}", plan.digest), progress
    ).run()
    lost = [[what, count] for what, count in losses]
    return {"commands": result.commands, "checked": result.checked, "lost": lost}


def _blocks(folder: Path, chosen: Parameters, progress: Progress) -> BlockVolume:
    progress("build", 0, 1)
    volume = built_volume(folder, chosen)
    progress("build", 1, 1)
    return volume
