"""Build a room into an existing world, either in its folder or on a running server."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import BuildOptions, Settings, blocks_of, path_of
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume

PASSWORD = "W2M_RCON_PASSWORD"  # The environment variable with the password of the console.

Corner = tuple[int, int, int]


@dataclass(frozen=True)
class WorldChange:
    """The changes that a build made to a world.

    Attributes:
        world: Folder of the world.
        corner: Block position of the room's floor corner.
        size_blocks: Number of blocks along x, y and z.
        blocks: Number of blocks that changed. 0 if the world already contained the build.
        entities: Number of entities that were added.
        recovered: Whether an earlier interrupted step was undone first.
        has_size_functions: Whether the world contains functions that scale the player to the room.
    """

    world: Path
    corner: Corner
    size_blocks: tuple[int, ...]
    blocks: int
    entities: int
    recovered: bool
    has_size_functions: bool


@dataclass(frozen=True)
class ServerBuild:
    """A room that was built on a server.

    Attributes:
        corner: Block position of the room's floor corner.
        size_blocks: Number of blocks along x, y and z.
        blocks: Number of blocks other than air.
        commands: Number of commands that were sent.
        reconnects: Number of times that a lost connection was restored.
        checked: Number of block positions that were read back and found correct.
        resumed: Whether an interrupted build of the same blocks was resumed.
        left_out: Contents that commands cannot create, with the count of each kind.
    """

    corner: Corner
    size_blocks: tuple[int, ...]
    blocks: int
    commands: int
    reconnects: int
    checked: int
    resumed: bool
    left_out: Mapping[str, int] = field(default_factory=dict)


def build_into_world(
    source: Run | str | Path,
    world: str | Path,
    at: Corner,
    *,
    turns: int = 0,
    air: str = "room",
    new_chunks: bool = False,
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    classes: str | Path = "",
    settings: Settings | None = None,
    progress: Progress = no_progress,
) -> WorldChange:
    """Build a room or the blocks of a file into an existing world.

    Every changed file is backed up. ``undo_build`` restores the backup.

    Args:
        source: Run, run folder, occupancy grid or block file.
        world: Folder of the world. The world must not be open in the game.
        at: Block position of the room's floor corner (x, y, z) in the world.
        turns: Number of quarter turns, counter-clockwise from above, applied before placement.
        air: Which air of the source replaces existing blocks: ``room``, ``box`` or ``none``.
        new_chunks: Create chunks that the game has not generated yet.
        blocks_per_metre: Scale of the room.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        classes: Class ids of an occupancy grid, such as ``embodied`` (12 is empty).
        settings: Further parameters, such as ``{"build.ceiling": "glass"}``.
        progress: Callback that reports the progress of each stage.

    Raises:
        UsageError: If an argument is invalid or the build extends beyond the world limits.
        ConflictError: If the world is open in the game.
        InputError: If the folder is not a world or lacks chunks.
        OutputError: If the disk is full.

    Example:
        >>> import shutil
        >>> import world2minecraft as w2m
        >>> world = shutil.copytree(run.world, tmp / "home")
        >>> w2m.build_into_world(run, world, at=(100, 64, 0), new_chunks=True).blocks > 1000
        True
    """
    from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
    from world2minecraft.editing.build_into_world import build_into_world, check_air
    from world2minecraft.editing.volume_relocation import place_volume
    from world2minecraft.minecraft.commands.player_scale import size_pack
    from world2minecraft.minecraft.worlds.session_lock import session_lock

    folder = Path(world)
    check_air(air)
    with session_lock(folder):  # What is wrong with the world is found before any work.
        pass
    options = BuildOptions(blocks_per_metre, style, palette, settings=settings, classes=classes)
    volume, is_room = _room_blocks(source, options, progress)
    put = place_volume(volume, at, turns, ROOM_CORNER_BLOCK[1] if is_room else None)
    has_scale = is_room and volume.blocks_per_metre != 1
    pack = {"datapacks/player_size.zip": size_pack(volume.blocks_per_metre)} if has_scale else None
    what = f"built at {at[0]} {at[1]} {at[2]}"
    done = build_into_world(folder, put, air=air, new_chunks=new_chunks, extra=pack, what=what)
    return WorldChange(
        world=folder,
        corner=at,
        size_blocks=put.states.shape,
        blocks=done.blocks if done.step is not None else 0,
        entities=done.entities,
        recovered=bool(done.recovered),
        has_size_functions=has_scale and done.step is not None,
    )


def build_on_server(
    source: Run | str | Path,
    server: str,
    *,
    at: Corner | None = None,
    turns: int = 0,
    air: str = "room",
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    mc_version: str = "1.20.1",
    classes: str | Path = "",
    settings: Settings | None = None,
    password: str | None = None,
    progress: Progress = no_progress,
) -> ServerBuild:
    """Build a room or the blocks of a file on a running server. The build cannot be undone.

    Call the function again with the same arguments to resume an interrupted build.

    Args:
        source: Run, run folder, occupancy grid or block file.
        server: Address of the remote console: ``HOST`` or ``HOST:PORT``.
        at: Block position of the room's floor corner (x, y, z). Defaults to (0, 64, 0).
        turns: Number of quarter turns, counter-clockwise from above, applied before placement.
        air: Which air of the source replaces existing blocks: ``room``, ``box`` or ``none``.
        blocks_per_metre: Scale of the room.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        mc_version: Minecraft version of the server.
        classes: Class ids of an occupancy grid, such as ``embodied`` (12 is empty).
        settings: Further parameters, such as ``{"build.ceiling": "glass"}``.
        password: Password of the remote console. Defaults to the environment variable
            W2M_RCON_PASSWORD.
        progress: Callback that reports the progress of each stage.

    Raises:
        UsageError: If an argument is invalid or the password is missing.
        ServerError: If the server refuses the connection or cannot be reached.
    """
    from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
    from world2minecraft.editing.build_into_world import affected_mask, check_air
    from world2minecraft.editing.volume_relocation import place_volume
    from world2minecraft.minecraft.file_format import Losses
    from world2minecraft.minecraft.server.rcon import RconClient, build_note_path, parse_address
    from world2minecraft.minecraft.server.server_build import LiveBuilder, plan_build
    from world2minecraft.minecraft.versions import game_version

    host, port = parse_address(server)
    secret = password or _password_of_environment()
    check_air(air)
    options = BuildOptions(
        blocks_per_metre,
        style,
        palette,
        mc_version=mc_version,
        settings=settings,
        classes=classes,
    )
    volume, is_room = _room_blocks(source, options, progress)
    corner = at or ROOM_CORNER_BLOCK
    volume = place_volume(volume, corner, turns, ROOM_CORNER_BLOCK[1] if is_room else None)
    losses, built = Losses(), affected_mask(volume, air)
    plan = plan_build(volume, game_version(mc_version), built=built, losses=losses)
    note = build_note_path(f"{host}:{port}", plan.digest)
    resumed = note.is_file()
    result = LiveBuilder(RconClient(host, port, secret), plan, note, progress).run()
    return ServerBuild(
        corner=corner,
        size_blocks=volume.states.shape,
        blocks=int((volume.states > 0).sum()),
        commands=result.commands,
        reconnects=result.reconnects,
        checked=result.checked,
        resumed=resumed,
        left_out=dict(losses),
    )


def check_place(
    at: Sequence[int] | None,
    turns: int,
    air: str,
    new_chunks: bool,
    *,
    has_world: bool,
    has_server: bool,
) -> None:
    """Check that placement arguments are used together with a world or a server.

    Args:
        at: Block position of the room's floor corner, or None.
        turns: Number of quarter turns.
        air: ``room``, ``box`` or ``none``.
        new_chunks: Whether missing chunks are to be created.
        has_world: Whether a world folder is given.
        has_server: Whether a server address is given.

    Raises:
        UsageError: If a placement argument has no world or server, or if ``air`` is unknown.
    """
    from world2minecraft.editing.build_into_world import check_air

    if has_world and at is None:
        raise UsageError("--into requires a block position; add --at X Y Z (see the F3 screen)")
    if not has_world and not has_server and (at is not None or turns):
        raise UsageError("--at and --turns require --into WORLD or --rcon HOST")
    check_air(air)
    if new_chunks and not has_world:
        raise UsageError("--new-chunks requires --into WORLD")
    if air != "room" and not has_world and not has_server:
        raise UsageError("--air requires --into WORLD or --rcon HOST")


def _room_blocks(
    source: Run | str | Path, options: BuildOptions, progress: Progress
) -> tuple["BlockVolume", bool]:
    """Return the blocks of a source, and whether the source is a room with a known floor height."""
    from world2minecraft.reconstruction.build_without_capture import is_block_file

    return blocks_of(source, options, progress), not is_block_file(path_of(source))


def _password_of_environment() -> str:
    """Return the console password from the environment, where other users cannot see it."""
    if not os.environ.get(PASSWORD):
        raise UsageError(
            f"--rcon requires a password; set the environment variable {PASSWORD} to the value of "
            "rcon.password in server.properties"
        )
    return os.environ[PASSWORD]
