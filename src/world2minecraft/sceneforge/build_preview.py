"""The edited scene as blocks, as it will look in the game.

A build is made and repaired as in ``w2m build``, and converted to a mesh for the Build view and to
collision boxes for walking. Nothing is written.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.construction import BuildParameters, build_volume, find_spawn
from world2minecraft.construction.parameters import STYLES
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import BlockVolume, OccupancyGrid, SceneObject
from world2minecraft.editing.cleanup.passes import repair_volume
from world2minecraft.editing.scene import instances_of, placements_of
from world2minecraft.minecraft.physics import BlockWorld, find_standing_place
from world2minecraft.reconstruction.file_stages import corner_m
from world2minecraft.rendering.mesh import mesh_of
from world2minecraft.rendering.mesh.packets import mesh_arrays, pack_arrays
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import read_source_rooms

MAGIC = b"W2MB"
MAX_CELLS = 12_000_000  # Maximum size of a build's bounding box; pages draw no more.
SCALE_RANGE = (0.25, 100.0)  # Blocks a metre, as ``Parameters`` allows.


@dataclass(frozen=True)
class BuildOptions:
    """Validated options of a build preview."""

    blocks_per_metre: float = 4.0
    style: str = "blocks"

    def __post_init__(self):
        low, high = SCALE_RANGE
        if not low <= self.blocks_per_metre <= high:
            text = f"blocks_per_metre must be {low} to {high:.0f}, got {self.blocks_per_metre}"
            raise UsageError(f"{text}; try 1, 2, 4 or 12.5")
        if self.style not in STYLES:
            raise UnknownNameError("style", self.style, STYLES)


@dataclass(frozen=True, eq=False)
class SceneSnapshot:
    """A copy of a scene, so that it can be built while editing continues.

    ``shown`` distinguishes it from other documents of the server at the same revision, as in
    ``Session.shown``.
    """

    rev: int
    name: str
    folder: Path
    grid: OccupancyGrid
    objects: tuple[SceneObject, ...]
    shown: int = 0

    @classmethod
    def of(cls, editor: Editor) -> "SceneSnapshot":
        """Copy the scene of an editor. Call this while no other request uses the editor."""
        objects = tuple(editor.draft.objects.values())
        grid = editor.draft.grid()
        return cls(editor.rev, editor.name, editor.opened.source, grid, objects)


@dataclass(frozen=True, eq=False)
class BlockBuild:
    """The blocks of a scene, and the data that the page receives about them."""

    rev: int
    options: BuildOptions
    volume: BlockVolume

    @classmethod
    def of(cls, scene: SceneSnapshot, options: BuildOptions) -> "BlockBuild":
        """Build a scene. This takes about a second for a room.

        Raises:
            UsageError: If the build would need too many blocks.
        """
        size = options.blocks_per_metre * scene.grid.voxel_m
        cells = float(np.prod(np.array(scene.grid.shape) * size + 4))
        if cells > MAX_CELLS:
            raise UsageError(
                f"{options.blocks_per_metre:g} blocks per metre need {cells:.3g} blocks, the limit "
                f"is {MAX_CELLS:,}; choose fewer blocks per metre"
            )
        volume = build_volume(
            scene.grid,
            placements_of(scene.objects),
            instances_of(scene.objects, scene.grid.instance),
            corner_m=corner_m(scene.folder, scene.grid),
            blocks_per_metre=options.blocks_per_metre,
            parameters=replace(BuildParameters(), style=options.style),
            name=scene.name,
            rooms=read_source_rooms(scene.folder, scene.grid),
        )
        return cls(scene.rev, options, repair_volume(volume)[0])

    @cached_property
    def start(self) -> tuple[tuple[float, float, float], float]:
        """The start of a walk: the feet position in cells of the volume, and Minecraft's yaw."""
        spawn = find_spawn(self.volume)
        world = BlockWorld.of_volume(self.volume)
        place = find_standing_place(world, spawn.position, self.options.blocks_per_metre)
        x, y, z = (float(v) for v in np.array(place) - self.volume.corner)
        return (x, y, z), spawn.yaw_deg

    def mesh_bytes(self) -> bytes:
        """Return the mesh in the format that ``web/src/build/mesh.ts`` reads."""
        mesh = mesh_of(self.volume)
        header = {
            **self.facts(),
            "style": self.options.style,
            "palette": list(self.volume.palette),
            "clear_from": mesh.clear_from,
            "texture_px": mesh.atlas.side_px,
            "blocks": int((self.volume.states > 0).sum()),
        }
        return pack_arrays(MAGIC, header, mesh_arrays(mesh))

    def facts(self) -> dict[str, Any]:
        """Return the header fields for the page: revision, transform and start position."""
        feet, yaw_deg = self.start
        return {
            "rev": self.rev,
            "blocks_per_metre": self.options.blocks_per_metre,
            "grid_to_room": self.volume.grid_to_room.ravel().tolist(),
            "feet": list(feet),
            "yaw_deg": yaw_deg,
        }
