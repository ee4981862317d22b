"""Build a room into a world that exists, in its folder or on a running server."""

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
    """What a build changed in a world.

    Attributes:
        world: the folder of the world.
        corner: where the corner of the room's floor stands.
        size_blocks: the blocks along x, y and z.
        blocks: how many blocks changed; 0 where all of them were there.
        entities: how many entities were added.
        recovered: an earlier step that had been interrupted was undone first.
        has_size_functions: the world has functions that scale the player to the room.
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
    """What was built on a server.

    Attributes:
        corner: where the corner of the room's floor stands.
        size_blocks: the blocks along x, y and z.
        blocks: how many of them are not air.
        commands: how many commands were sent.
        reconnects: how many lost connections were survived.
        checked: how many places were read back, all of them right.
        resumed: an earlier build of the same blocks had been interrupted and was continued.
        left_out: what commands cannot carry, with its count.
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
    settings: Settings | None = None,
    progress: Progress = no_progress,
) -> WorldChange:
    """Build a room, or the blocks of a file, into an existing world.

    Every file that changes is backed up; ``undo_build`` restores it.

    Args:
        source: a run, its folder, an occupancy grid, or a block file.
        world: the folder of the world; the game must not have it open.
        at: where the corner of the room's floor stands, in blocks of the world.
        turns: quarter turns before that, counter-clockwise from above.
        air: which air of the room replaces blocks of the world: ``room``, ``box`` or ``none``.
        new_chunks: make chunks that the game has never generated.
        blocks_per_metre: the scale of the room.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        settings: further parameters, such as ``{"build.ceiling": "glass"}``.
        progress: called at each step.

    Raises:
        UsageError: an argument is wrong, or the build reaches out of the world.
        ConflictError: the game has the world open. InputError: the folder is not a world, or
        lacks chunks. OutputError: the disk is full.

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
    options = BuildOptions(blocks_per_metre, style, palette, settings=settings)
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
    settings: Settings | None = None,
    password: str | None = None,
    progress: Progress = no_progress,
) -> ServerBuild:
    """Build a room, or the blocks of a file, on a running server; this cannot be undone.

    A build that was interrupted continues when it is called again.

    Args:
        source: a run, its folder, an occupancy grid, or a block file.
        server: ``HOST`` or ``HOST:PORT`` of the remote console.
        at: where the corner of the room's floor stands; (0, 64, 0) by default.
        turns: quarter turns before that, counter-clockwise from above.
        air: which air of the room replaces blocks: ``room``, ``box`` or ``none``.
        blocks_per_metre: the scale of the room.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        mc_version: the game version of the server.
        settings: further parameters, such as ``{"build.ceiling": "glass"}``.
        password: of the console; the environment variable W2M_RCON_PASSWORD by default.
        progress: called at each step.

    Raises:
        UsageError: an argument or the password is missing or wrong.
        ServerError: the server refuses, or cannot be reached.
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
        blocks_per_metre, style, palette, mc_version=mc_version, settings=settings
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
    """Check that arguments about a place go with a world or a server.

    Raises:
        UsageError: they do not, or ``air`` is unknown.
    """
    from world2minecraft.editing.build_into_world import check_air

    if has_world and at is None:
        raise UsageError("--into needs a place: add --at X Y Z, as the F3 screen shows it")
    if not has_world and not has_server and (at is not None or turns):
        raise UsageError("--at and --turns need --into WORLD or --rcon; add one or leave them out")
    check_air(air)
    if new_chunks and not has_world:
        raise UsageError("--new-chunks needs --into WORLD; add it or leave it out")
    if air != "room" and not has_world and not has_server:
        raise UsageError("--air needs --into WORLD or --rcon; add one or leave it out")


def _room_blocks(
    source: Run | str | Path, options: BuildOptions, progress: Progress
) -> tuple["BlockVolume", bool]:
    """Return the blocks, and whether they are a room of ours, whose floor is known."""
    from world2minecraft.reconstruction.build_without_capture import is_block_file

    return blocks_of(source, options, progress), not is_block_file(path_of(source))


def _password_of_environment() -> str:
    """Return the console's password; an option would show it to everyone on the machine."""
    if not os.environ.get(PASSWORD):
        raise UsageError(
            f"--rcon takes the password from the environment: export {PASSWORD}=... "
            "(rcon.password in server.properties)"
        )
    return os.environ[PASSWORD]
