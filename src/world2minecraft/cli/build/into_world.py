"""What ``w2m build --into`` does: puts blocks into a world of the user, and says how to undo it."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume


def check_world(world: Path, air: str) -> None:
    """Check what can be known before any work.

    Raises:
        InputError: there is no world. ConflictError: the game has it open.
        UsageError: no such ``air``.
    """
    from world2minecraft.editing.build_into_world import check_air
    from world2minecraft.minecraft.worlds.session_lock import session_lock

    check_air(air)
    with session_lock(world):
        pass


def into_world(
    volume: "BlockVolume",
    world: Path,
    at: tuple[int, int, int],
    turns: int,
    *,
    air: str,
    new_chunks: bool,
    is_room: bool,
) -> None:
    """Build a volume into a world, and say what changed.

    Args:
        volume: the blocks.
        world: the world's folder.
        at: where the blocks' smallest x and z, and their ground, come to stand.
        turns: quarter turns before that.
        air: which air is built.
        new_chunks: whether chunks that the game never generated are made.
        is_room: whether the volume is a room of ours, whose ground is at the usual height.

    Raises:
        UsageError, InputError: as ``edit.into_world.build_into``.
    """
    from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
    from world2minecraft.editing.build_into_world import build_into_world
    from world2minecraft.editing.volume_relocation import place_volume
    from world2minecraft.minecraft.commands.player_scale import size_pack

    ground_y = ROOM_CORNER_BLOCK[1] if is_room else None
    put = place_volume(volume, at, turns, ground_y)
    pack = {"datapacks/player_size.zip": size_pack(volume.blocks_per_metre)}
    has_scale = is_room and volume.blocks_per_metre != 1
    done = build_into_world(
        world,
        put,
        air=air,
        new_chunks=new_chunks,
        extra=pack if has_scale else None,
        what=f"built at {at[0]} {at[1]} {at[2]}",
    )
    if done.recovered:
        print("An earlier step had been cut off; what it had touched was brought back first.")
    if done.step is None:
        print(f"{world}: all of it is there already; nothing was changed.")
        return
    _print_summary(world, put, at, done.blocks, done.entities, has_scale)


def _print_summary(
    world: Path,
    put: "BlockVolume",
    at: tuple[int, int, int],
    blocks: int,
    entities: int,
    has_scale: bool,
) -> None:
    size = " x ".join(map(str, put.states.shape))
    more = f" and {entities} entities" if entities else ""
    middle = [at[axis] + put.states.shape[axis] // 2 for axis in (0, 2)]
    print(f"{world}: {blocks:,} blocks changed{more}; the build is {size} blocks.")
    print(f"  go there   /tp @s {middle[0]} {at[1]} {middle[1]}")
    if has_scale:
        print("  your size  /function w2m:human_size, and back /function w2m:game_size")
    print(f"  undo       w2m undo '{world}'")
