"""The output files of a build: world, schematic, data pack and scene labels."""

from pathlib import Path

from world2minecraft.construction.spawn import find_spawn
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.object_names import NamedObject
from world2minecraft.formats.world_labels import scene_from_volume, write_scene
from world2minecraft.minecraft.commands.datapack import has_packs, write_datapack
from world2minecraft.minecraft.entities import check_displays
from world2minecraft.minecraft.schematics.sponge import write_schem
from world2minecraft.minecraft.versions import DEFAULT_VERSION, game_version
from world2minecraft.minecraft.worlds.world_writer import write_world

WORLD_NAME = "World2Minecraft room"  # Where nothing says what the room is called.


def write_build(
    folder: str | Path,
    volume: BlockVolume,
    *,
    mc_version: str = DEFAULT_VERSION,
    name: str = WORLD_NAME,
    objects: tuple[NamedObject, ...] = (),
) -> None:
    """Write ``world/``, ``room.schem``, ``datapack.zip``, ``scene.json`` and ``scene.npz``.

    The data pack is omitted for Minecraft versions before 1.20.

    Args:
        folder: Output folder; created if it does not exist.
        volume: The blocks of the room.
        mc_version: Minecraft version to write for, such as ``1.20.1``.
        name: Name of the world in the game's list.
        objects: Names of the objects.

    Raises:
        UnknownNameError: If the Minecraft version is unknown.
        OutputError: If the folder cannot be written.
        UsageError: If the Minecraft version lacks a block of the build.
    """
    target = Path(folder)
    version = game_version(mc_version)
    check_displays(volume, version)
    spawn = find_spawn(volume)
    write_world(
        volume,
        target / "world",
        name=name,
        spawn=spawn.position,
        spawn_yaw_deg=spawn.yaw_deg,
        version=version,
    )
    write_schem(volume, target / "room.schem", version=version)
    if has_packs(version):
        write_datapack(volume, target / "datapack.zip", version=version, name="room")
    else:
        (target / "datapack.zip").unlink(missing_ok=True)
    scene = scene_from_volume(
        volume,
        mc_version=version.name,
        data_version=version.data_version,
        spawn=spawn.position,
        spawn_yaw_deg=spawn.yaw_deg,
        objects=objects,
    )
    write_scene(target, scene)
