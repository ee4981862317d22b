"""Scenes for navigation from blocks received from a game server.

The body is the game's own player at any scale, so at 4 blocks per metre it is a robot of 0.45 m.
Doors keep their state. Rendering follows block changes, but the floor, the paths and the landmarks
are those at the time when the scene was created. ``ServerSimulator`` walks episodes in such scenes.
"""

from functools import cached_property
from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import BlockVolume, Camera, Layout
from world2minecraft.formats.build_reader import BuildSource, PlayerStart
from world2minecraft.formats.volume_crop import trim_air
from world2minecraft.formats.volume_formats import with_scene_labels
from world2minecraft.formats.world_labels import read_scene
from world2minecraft.minecraftocc.scene_sources import open_scene_source, source_of_blocks
from world2minecraft.navigation.running.simulator import SceneSimulator, Simulator
from world2minecraft.navigation.scene import VlnScene, layouts_beside
from world2minecraft.navigation.server.actions import ServerDiscreteActions
from world2minecraft.navigation.server.player import ServerPlayer
from world2minecraft.navigation.server.streamed_blocks import Box, checked_box
from world2minecraft.navigation.types import Move, MoveSet, Stance
from world2minecraft.rendering.editable_scene import EditableScene
from world2minecraft.rendering.scene import BlockScene

AROUND, UNDER, ABOVE = 32, 8, 24  # Blocks around the player that are read without a box.
EDGE = 2  # Additional blocks around a scene.


class ServerScene(VlnScene):
    """A scene whose blocks are on a game server. Create it with ``open_server_scene``."""

    def __init__(self, source: BuildSource, scene_id: str, server: ServerPlayer):
        scale = source.volume.blocks_per_metre
        self.server, self._labels = server, source.folder
        super().__init__(source_of_blocks(source, scene_id), 1 / scale, opens_doors=False)

    @cached_property
    def live(self) -> EditableScene:
        """The scene for rendering, which follows the block changes on the server."""
        return EditableScene(self.volume)

    @property
    def render_scene(self) -> BlockScene:  # type: ignore[override]
        """The scene prepared for rendering, with all block changes received from the server."""
        self._follow()
        return self.live.scene

    @cached_property
    def layouts(self) -> tuple[Layout, ...]:
        """The floor plans stored beside the labels."""
        return layouts_beside(self._labels) if self._labels else ()

    def _follow(self) -> None:
        """Apply the block changes, or read all blocks again after too many changes."""
        if self.server.has_many_changes:
            self.server.take_changes()
            low, shape = np.array(self.volume.corner), np.array(self.volume.states.shape)
            volume = self.server.read([*low.tolist(), *(low + shape).tolist()])
            names = np.array(volume.palette)[volume.states]
            old_states, old_palette = self.live.volume_states
            cells = np.argwhere(names != np.array(old_palette)[old_states])
            changes = [(cell, str(names[tuple(cell)])) for cell in cells]
        else:
            taken = self.server.take_changes()
            corner = np.array(self.volume.corner)
            changes = [(np.array(one.place) - corner, one.state) for one in taken]
        shape = self.volume.states.shape
        inside = [(cell, state) for cell, state in changes if _is_in(cell, shape)]
        if inside:
            cells = np.array([cell for cell, _ in inside])
            self.live.set_blocks(cells, [state for _, state in inside])


def open_server_scene(
    server: ServerPlayer,
    *,
    labels: str | Path | None = None,
    box: Box | None = None,
    blocks_per_metre: float | None = None,
) -> ServerScene:
    """Create a scene from the blocks around a player or in a box.

    Args:
        server: The player.
        labels: A run, house or build that is in the world at its own coordinates. It provides the
            classes, the names of objects, the scale and the box.
        box: The block range x0 y0 z0 x1 y1 z1 with exclusive ends.
        blocks_per_metre: The scale if no labels are given. The default is 1.

    Raises:
        UsageError: If an option is invalid.
        InputError: If the labels cannot be read or do not fit the blocks, or there is no floor.
        ServerError: If the blocks have not been received.
    """
    if labels is not None and blocks_per_metre is not None:
        raise UsageError("the labels already define the scale; omit blocks_per_metre")
    if blocks_per_metre is not None and not 0 < blocks_per_metre <= 64:
        raise UsageError(f"blocks_per_metre must be above 0 and at most 64, got {blocks_per_metre}")
    folder = None if labels is None else _scene_folder(Path(labels))
    wanted = checked_box(box) if box else _box_of(folder) if folder else _around(server)
    volume = server.read(wanted)
    where = f"server {server.address}"
    if not volume.states.any():
        raise InputError(where, "the box contains only air; choose another")
    if folder is None:
        source = BuildSource(
            _scaled(trim_air(volume), blocks_per_metre or 1.0), "server", Path(where)
        )
    else:
        path = Path(str(labels))  # Walks can then be repeated there, without a server.
        scene = read_scene(folder)
        start = PlayerStart(*scene.spawn, scene.spawn_yaw_deg)
        source = BuildSource(_labelled(volume, folder, where), "server", path, start, folder)
    return ServerScene(source, _scene_id(server, labels), server)


def _labelled(volume: BlockVolume, folder: Path, where: str) -> BlockVolume:
    known = with_scene_labels(volume, folder)
    if not known.semantic.any():
        raise InputError(
            where, f"the blocks of {folder} are not in the world at this position; build them first"
        )
    return trim_air(known)


def _scene_folder(path: Path) -> Path:
    for folder in (path, path / "build", path.parent):
        if (folder / "scene.npz").is_file() and (folder / "scene.json").is_file():
            return folder
    raise InputError(
        path,
        "does not contain scene.json with scene.npz; give the folder of a run or of a "
        "generated house",
    )


def _box_of(folder: Path) -> Box:
    scene = read_scene(folder)
    low = np.array(scene.corner) - EDGE
    high = np.add(scene.corner, scene.semantic.shape) + EDGE
    return checked_box([*low.tolist(), *high.tolist()])


def _around(server: ServerPlayer) -> Box:
    x, y, z = (int(np.floor(value)) for value in server.body.position)
    return x - AROUND, y - UNDER, z - AROUND, x + AROUND, y + ABOVE, z + AROUND


def _scaled(volume: BlockVolume, blocks_per_metre: float) -> BlockVolume:
    to_room = block_to_room(np.zeros(2), blocks_per_metre)
    return BlockVolume(
        volume.states, volume.palette, volume.semantic, volume.instance, volume.corner, to_room
    )


def _scene_id(server: ServerPlayer, labels: str | Path | None) -> str:
    if labels is not None:
        return open_scene_source(labels).scene_id
    return "server_" + "".join(c if c.isalnum() else "_" for c in server.address)


def _is_in(cell: np.ndarray, shape: tuple[int, ...]) -> bool:
    return bool(((cell >= 0) & (cell < shape)).all())


class ServerSimulator(SceneSimulator):
    """A simulator that moves a player on a server, with an ``offline`` variant for planning."""

    def __init__(
        self, scene: ServerScene, move_set: str | MoveSet = "vlnce", camera: Camera | None = None
    ):
        super().__init__(scene, move_set, camera)
        self._controller = ServerDiscreteActions(scene, self.move_set, scene.server)

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Make a move, after placing the player at the start of the move if necessary."""
        if stance != self._controller.stance:
            self._controller.begin(stance)
        if move == Move.STOP:
            return stance, False
        self._controller.stance, collided = self._controller.apply(move)
        return self._controller.stance, collided

    @property
    def offline(self) -> Simulator:
        """A simulator of the scene alone, for planning without moving the player."""
        return SceneSimulator(self.scene, self.move_set, self.camera)
