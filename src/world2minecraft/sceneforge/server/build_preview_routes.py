"""The routes that return the scene as blocks, and lead through them.

=======================  =====================================================================
``GET /api/build``       the mesh of a build
``GET /api/collision``   what stops a walker in a build, or in the voxels
``GET /api/way``         the way to an object: ``to`` is the typed text, ``feet_m`` the start
=======================  =====================================================================

Builds are made by a thread, one at a time, while the scene can still be edited. The last few builds
are cached. A build that takes longer is announced to all tabs as a job. Walking in the page follows
the physics of ``minecraft.physics``: the page receives the shape of each cell, the boxes of each
shape, and the start position.
"""

import asyncio
import zlib
from collections import OrderedDict
from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.minecraft.physics import BlockWorld, find_standing_place
from world2minecraft.rendering.mesh.packets import pack_arrays
from world2minecraft.sceneforge.block_arrays import collision_arrays
from world2minecraft.sceneforge.build_preview import BlockBuild, BuildOptions, SceneSnapshot
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.jobs.jobs import JobState, describe_error
from world2minecraft.sceneforge.server.request_parsing import parse_point, parse_scale
from world2minecraft.sceneforge.session import Session
from world2minecraft.sceneforge.walk_guide import Feet, WalkGuide

MAGIC = b"W2MC"
MAX_CACHED = 6  # Packed answers; a room has about a megabyte each.
MAX_SENTENCE = 200
NOTIFY_AFTER_S = 1.0  # Faster builds are not announced.


def build_collision(build: BlockBuild) -> bytes:
    """Return the collision boxes of a build, in cells of its volume."""
    world = BlockWorld.of_volume(build.volume)
    return pack_arrays(MAGIC, build.facts(), collision_arrays(world))


def voxel_collision(scene: SceneSnapshot) -> bytes:
    """Return the occupied cells of a scene as full cubes in block axes, one block per voxel."""
    grid = scene.grid
    solid = np.moveaxis(grid.occupied[:, ::-1], 1, 2)  # Room -y is block z.
    world = BlockWorld.of_cells(solid)
    feet, yaw_deg = _start(grid, world)
    facts = {
        "rev": scene.rev,
        "blocks_per_metre": 1 / grid.voxel_m,
        "grid_to_room": _block_axes_to_room(grid).ravel().tolist(),
        "feet": list(feet),
        "yaw_deg": yaw_deg,
    }
    return pack_arrays(MAGIC, facts, collision_arrays(world))


def _block_axes_to_room(grid: OccupancyGrid) -> np.ndarray:
    """Return the transform from cells in block axes (x, z, -y) to room metres, float64 [4, 4]."""
    x, y, z = grid.origin_m
    v = grid.voxel_m
    return np.array(
        [[v, 0, 0, x], [0, 0, -v, y + grid.shape[1] * v], [0, v, 0, z], [0, 0, 0, 1]], np.float64
    )


def _start(grid: OccupancyGrid, world: BlockWorld) -> tuple[tuple[float, float, float], float]:
    """Return a start position in the middle of the floor, facing the middle of the furniture."""
    axes = np.linalg.inv(_block_axes_to_room(grid))
    floor = _middle(grid, grid.labels == SemanticClass.FLOOR)
    things = _middle(grid, np.isin(grid.labels, OBJECT_CLASSES))
    top = np.flatnonzero((grid.labels == SemanticClass.FLOOR).any(axis=(0, 1)))
    feet = axes @ [*floor[:2], grid.origin_m[2] + (top[-1:].sum() + 1) * grid.voxel_m, 1]
    x, y, z = (float(round(value, 6)) for value in feet[:3])
    place = find_standing_place(world, (x, y, z), 1 / grid.voxel_m)
    way = (axes @ [*things, 1])[:3] - np.array(place)
    yaw_deg = float(np.degrees(np.arctan2(-way[0], way[2]))) if np.hypot(way[0], way[2]) else 0.0
    return place, round(yaw_deg, 3)


def _middle(grid: OccupancyGrid, where: np.ndarray) -> np.ndarray:
    """Return the centre of cells in room metres, or of the whole grid without cells."""
    cells = np.argwhere(where)
    middle = np.median(cells, axis=0) + 0.5 if len(cells) else np.array(grid.shape) / 2
    return grid.origin_m + middle * grid.voxel_m


Key = tuple[Any, ...]
Made = TypeVar("Made")


class BuildCache:
    """The builds of a server, made one after another, of which the latest are cached."""

    def __init__(self, session: Session):
        self.session = session
        self._turn = asyncio.Lock()
        self._volumes: OrderedDict[Key, BlockBuild] = OrderedDict()
        self._packed: OrderedDict[Key, bytes] = OrderedDict()
        self._guide: tuple[Key, WalkGuide] | None = None

    async def build(self, options: BuildOptions) -> tuple[int, bytes]:
        """Return the revision of the scene that was built, and the packed mesh of the build."""
        return await self._made(
            ("mesh", options), lambda scene: self._of(scene, options).mesh_bytes()
        )

    async def collision(self, options: BuildOptions | None) -> tuple[int, bytes]:
        """Return the revision and the packed collision boxes of a build, or of the voxels.

        Args:
            options: Options of the build. None returns the boxes of the voxels.
        """
        if options is None:
            return await self._made(("voxels",), voxel_collision)
        return await self._made(
            ("boxes", options), lambda scene: build_collision(self._of(scene, options))
        )

    async def way(self, sentence: str, feet_m: Feet, options: BuildOptions) -> dict[str, Any]:
        """Return the answer of ``WalkGuide`` in a build.

        Raises:
            InputError: If there is no floor to stand on.
        """
        guide = await self.guide(options)
        async with self._turn:
            return await asyncio.to_thread(guide.answer, sentence, feet_m)

    async def guide(self, options: BuildOptions) -> WalkGuide:
        """Return the guide through a build.

        Raises:
            InputError: If there is no floor to stand on.
        """
        async with self._turn:
            scene = await self.session.read(self._held)
            return await self._told(asyncio.to_thread(lambda: self._guided(scene, options)))

    def _guided(self, scene: SceneSnapshot, options: BuildOptions) -> WalkGuide:
        """Return the guide of a build. The last one is kept: people ask more than once."""
        key = (scene.shown, scene.rev, options)
        if self._guide is None or self._guide[0] != key:
            volume = self._of(scene, options).volume
            self._guide = (key, WalkGuide(volume, scene.objects, scene.name))
        return self._guide[1]

    def _held(self, editor: Editor) -> SceneSnapshot:
        """Copy the scene in its turn, because another room may be opened during the build."""
        return replace(SceneSnapshot.of(editor), shown=self.session.shown)

    def _of(self, scene: SceneSnapshot, options: BuildOptions) -> BlockBuild:
        """Return the build of a scene. Only one thread at a time may call this."""
        key = (scene.shown, scene.rev, options)
        if key not in self._volumes:
            self._volumes[key] = BlockBuild.of(scene, options)
            while len(self._volumes) > 2:
                self._volumes.popitem(last=False)
        return self._volumes[key]

    async def _made(self, what: Key, make: Callable[[SceneSnapshot], bytes]) -> tuple[int, bytes]:
        async with self._turn:
            document = self.session.document
            key = (*what, self.session.shown, document.rev)
            if key in self._packed:
                return document.rev, self._packed[key]
            scene = await self.session.read(self._held)
            packed = await self._told(asyncio.to_thread(lambda: _gzip(make(scene))))
            self._packed[(*what, scene.shown, scene.rev)] = packed
            while len(self._packed) > MAX_CACHED:
                self._packed.popitem(last=False)
            return scene.rev, packed

    async def _told(self, work: Coroutine[Any, Any, Made]) -> Made:
        """Wait for a build, and announce it to the tabs after a second."""
        task = asyncio.ensure_future(work)
        done, _ = await asyncio.wait([task], timeout=NOTIFY_AFTER_S)
        if done:
            return task.result()
        state = JobState("build", "Building blocks", "build")
        self.session.broadcaster.broadcast(state.message())
        try:
            made = await task
        except Exception as error:
            self.session.broadcaster.broadcast(
                replace(state, state="failed", note=describe_error(error)).message()
            )
            raise
        self.session.broadcaster.broadcast(replace(state, state="done").message())
        return made


def build_routes() -> list[BaseRoute]:
    """Return the routes. They build the scene of ``state.session`` of the application."""
    return [
        Route("/api/build", _build),
        Route("/api/collision", _collision),
        Route("/api/way", _way),
    ]


async def _build(request: Request) -> Response:
    options = _options(request)
    return _answer(request, *await builds_of(request).build(options))


async def _collision(request: Request) -> Response:
    what = request.query_params.get("what", "build")
    if what not in ("build", "voxels"):
        raise UsageError(f"what must be 'build' or 'voxels', got {what!r}")
    options = _options(request) if what == "build" else None
    return _answer(request, *await builds_of(request).collision(options))


async def _way(request: Request) -> Response:
    query = request.query_params
    sentence = check_sentence(query.get("to", ""))
    feet_m = parse_point("feet_m", query.get("feet_m", "").split(","), "1.5,2,0")
    # Entities have no blocks of their own: furniture stands where its blocks would.
    options = replace(_options(request), style="blocks")
    return JSONResponse(await builds_of(request).way(sentence, feet_m, options))


def check_sentence(text: Any) -> str:
    """Return what was typed, without white space at its ends.

    Raises:
        UsageError: If it is no text, or too short or long.
    """
    sentence = text.strip() if isinstance(text, str) else ""
    if not 0 < len(sentence) <= MAX_SENTENCE:
        raise UsageError(f"to must be 1 to {MAX_SENTENCE} characters, such as: go to the lamp")
    return sentence


def builds_of(request: Request) -> BuildCache:
    """Return the builds of the server that received a request."""
    state = request.app.state
    if not hasattr(state, "builds"):
        state.builds = BuildCache(state.session)
    return state.builds


def _options(request: Request) -> BuildOptions:
    """Return the build options of a request.

    Raises:
        UsageError: If an option is invalid.
    """
    query = request.query_params
    size = parse_scale(query.get("blocks_per_metre", "4"), str)
    return BuildOptions(size, query.get("style", "blocks"))


def _answer(request: Request, rev: int, packed: bytes) -> Response:
    headers = {"X-Rev": str(rev), "Vary": "Accept-Encoding"}
    if "gzip" in request.headers.get("accept-encoding", ""):
        headers["Content-Encoding"] = "gzip"
    else:
        packed = zlib.decompress(packed, 31)
    return Response(packed, headers=headers, media_type="application/octet-stream")


def _gzip(raw: bytes) -> bytes:
    packer = zlib.compressobj(1, zlib.DEFLATED, 31)
    return packer.compress(raw) + packer.flush()
