"""The mesh of a volume shows what rays see of it: surfaces, owners, textures, tints and light."""

import numpy as np
import pytest
from tests.rendering.scenes import random_pose

from world2minecraft.core.coordinates import block_to_room, look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.minecraft.entities import block_display
from world2minecraft.rendering import NEUTRAL, prepare_scene, render_volume
from world2minecraft.rendering.cutaway import without_ceiling, without_near_walls
from world2minecraft.rendering.light.light_settings import (
    NEUTRAL_CORNER,
    NEUTRAL_EXPOSURE,
    NEUTRAL_HEADLIGHT,
)
from world2minecraft.rendering.mesh import BlockMesh, mesh_of
from world2minecraft.rendering.mesh.baking import CORNERS, merge_faces

PALETTE = (
    "minecraft:air",
    "minecraft:white_concrete",
    "minecraft:oak_planks",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:oak_slab[type=bottom,waterlogged=false]",
    "minecraft:glass",
    "minecraft:red_stained_glass",
    "minecraft:oak_leaves[distance=7,persistent=true,waterlogged=false]",
    "minecraft:lantern[hanging=false,waterlogged=false]",
    "minecraft:iron_bars[east=true,north=false,south=false,waterlogged=false,west=true]",
)
WIDE = Camera(48, 36, 20.0, 20.0, 24.0, 18.0)
NARROW = Camera(48, 36, 90.0, 90.0, 24.0, 18.0)


def volume_of(states, entities=(), semantic=None):
    filled = states > 0
    return BlockVolume(
        states=states.astype(np.uint16),
        palette=PALETTE,
        semantic=(filled * 10).astype(np.uint8) if semantic is None else semantic,
        instance=(states * 3).astype(np.uint16),
        corner=(-1, 63, -2),
        block_to_room=block_to_room(np.array([0.0, 2.0]), 4.0),
        entities=tuple(entities),
    )


def crowded(rng, share=0.12, entities=()):
    shape = (8, 6, 7)
    return volume_of(
        np.where(rng.random(shape) < share, rng.integers(1, len(PALETTE), shape), 0), entities
    )


def furnished(rng):
    displays = [
        block_display(
            "minecraft:oak_planks",
            np.array([0, 0, 0, 1.4, 0.3, 0.7]),
            rng.uniform([1, 64, 0], [4, 67, 3]),
            yaw_deg=float(rng.uniform(0, 360)),
            class_id=8,
            instance=77,
        )
        for _ in range(6)
    ]
    return crowded(rng, 0.06, displays)


def rays_of(volume, pose, camera):
    """Origin [3] and directions [H, W, 3] in cells of the volume; a camera's z of 1 is t of 1."""
    u, v = np.meshgrid(np.arange(camera.width_px) + 0.5, np.arange(camera.height_px) + 0.5)
    x, y = (u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px
    to_grid = np.linalg.inv(volume.block_to_room)
    to_grid[:3, 3] -= volume.corner
    turn = to_grid[:3, :3] @ pose[:3, :3]
    origin = to_grid[:3, :3] @ pose[:3, 3] + to_grid[:3, 3]
    return origin, np.stack([x, y, np.ones_like(x)], axis=-1) @ turn.T


def first_quads(mesh: BlockMesh, origin, directions):
    """A slow picture of the mesh: t, quad and colour of what each ray meets first; -1 for none."""
    corners = mesh.position.astype(np.float64)
    one, two = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    normal = np.cross(one, two)
    flat = directions.reshape(-1, 3)
    depth = np.full(len(flat), np.inf)
    found = np.full(len(flat), -1)
    places = np.zeros((len(flat), 2))
    for number in range(len(mesh)):
        steep = flat @ normal[number]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (corners[number, 0] - origin) @ normal[number] / steep
            offset = origin + t[:, None] * flat - corners[number, 0]
            a = offset @ one[number] / (one[number] @ one[number])
            b = offset @ two[number] / (two[number] @ two[number])
            hit = (steep < 0) & (t > 1e-9) & (t <= depth) & (a >= 0) & (a <= 1)
            hit &= (b >= 0) & (b <= 1)
        if number < mesh.clear_from:
            hit[hit] &= texels(mesh, number, a[hit], b[hit])[:, 3] >= 128
        depth[hit], found[hit] = t[hit], number
        places[hit] = np.stack([a, b], axis=1)[hit]
    return depth, found, places


def texels(mesh, number, a, b):
    uv = mesh.uv[number].astype(np.float64)
    at = uv[0] + a[:, None] * (uv[1] - uv[0]) + b[:, None] * (uv[3] - uv[0])
    side = mesh.atlas.side_px
    column, row = np.minimum((at % 1) * side, side - 1).astype(int).T
    return mesh.atlas.texels[mesh.layer[number], row * side + column]


def compared(volume, pose, camera):
    mesh = mesh_of(volume)
    scene = prepare_scene(volume)
    outputs = ("colour", "semantic", "instance", "opaque")
    seen = render_volume(scene, camera, pose, outputs=outputs, light=NEUTRAL)
    origin, directions = rays_of(volume, pose, camera)
    depth, found, places = first_quads(mesh, origin, directions)
    return mesh, seen, depth, found, places, directions.reshape(-1, 3)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", [crowded, furnished])
def test_rays_meet_quads_where_they_meet_blocks(make, seed):
    rng = np.random.default_rng(seed)
    volume = make(rng)
    met = 0
    for _ in range(3):
        mesh, seen, depth, found, _, _ = compared(volume, random_pose(rng, volume), WIDE)
        told, hits = seen.depth_m.ravel(), found >= 0
        agree = (hits == (told > 0)) & (~hits | (np.abs(np.where(hits, depth, 0) - told) < 1e-4))
        assert agree.mean() > 0.995  # Where a ray grazes an edge either may be right.
        both = agree & hits
        same = mesh.instance[found[both]] == seen.instance.ravel()[both]
        same &= mesh.semantic[found[both]] == seen.semantic.ravel()[both]
        assert (~same).sum() <= 0.005 * len(same)
        met += both.sum()
    assert met > 500


@pytest.mark.parametrize("make", [crowded, furnished])
def test_quads_have_the_colours_that_rays_see(make):
    rng = np.random.default_rng(7)
    errors = []
    for _ in range(8):
        volume = make(rng)
        mesh, seen, depth, found, places, ways = compared(volume, random_pose(rng, volume), NARROW)
        opaque = (found >= 0) & (found < mesh.clear_from) & (mesh.emission[found] == 0)
        close = depth * 4 < 0.6 * NARROW.fx_px / 16  # The finest level of the textures is seen.
        for row in np.flatnonzero(opaque & close):
            told = seen.colour.reshape(-1, 3)[row].astype(float)
            errors.append(np.abs(colour_of(mesh, found[row], places[row], ways[row]) - told).max())
    assert len(errors) > 200
    assert np.mean(np.array(errors) < 6) > 0.97


def colour_of(mesh, number, place, direction):
    """The screen colour of a place of a quad in the even light of the preview."""
    a, b = place
    texel = texels(mesh, number, np.array([a]), np.array([b]))[0, :3].astype(float)
    light = mesh.light[number].astype(float)  # Corners 0 to 3, bilinear.
    dark = (
        (1 - a) * ((1 - b) * light[0] + b * light[3]) + a * ((1 - b) * light[1] + b * light[2])
    )[2]
    corners = mesh.position[number].astype(float)
    normal = np.cross(corners[1] - corners[0], corners[3] - corners[0])
    cosine = abs(normal @ direction) / np.linalg.norm(normal) / np.linalg.norm(direction)
    shade = mesh.shade[number] / 255 * (1 - NEUTRAL_CORNER * dark / 80)
    shade *= 1 - NEUTRAL_HEADLIGHT * (1 - cosine)
    return np.clip(texel * (mesh.tint[number] / 255) * shade * NEUTRAL_EXPOSURE, 0, 255)


def areas(mesh):
    corners = mesh.position.astype(float)
    edges = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    return np.linalg.norm(np.cross(*edges), axis=1)


def test_full_cubes_hide_each_other_and_join():
    states = np.zeros((8, 7, 7), int)
    states[1:7, 1:6, 1:6] = 1
    whole = volume_of(states)
    mesh = mesh_of(BlockVolume(**{**vars(whole), "instance": np.zeros_like(whole.instance)}))
    assert areas(mesh).sum() == 2 * (25 + 30 + 30)
    top = (mesh.position[..., 1] == 6).all(axis=1)
    assert areas(mesh)[top].tolist() == [30]


def test_what_can_be_hidden_keeps_what_is_behind_it():
    states = np.zeros((4, 3, 3), int)
    states[1:3, 1, 1] = 1
    semantic = (states * 3).astype(np.uint8)
    semantic[2, 1, 1] = 5
    whole = volume_of(states, semantic=semantic)
    mesh = mesh_of(BlockVolume(**{**vars(whole), "instance": np.zeros_like(whole.instance)}))
    assert len(mesh) == 12  # Two cubes of two classes: each has six sides.
    assert sorted(mesh.cover.tolist()) == [3, 5] + [65535] * 10, "two of them lie on each other"


def test_a_volume_of_air_has_no_quads():
    mesh = mesh_of(volume_of(np.zeros((2, 2, 2), int)))
    assert len(mesh) == 0 and mesh.position.shape == (0, 4, 3)


def test_cuts_are_those_of_the_preview():
    states = np.zeros((9, 7, 9), int)
    states[[0, 8]], states[:, :, [0, 8]], states[:, [0, 6]] = 1, 1, 1
    semantic = (states * 3).astype(np.uint8)
    semantic[1:8, 0, 1:8], semantic[1:8, 6, 1:8] = 2, 1
    volume = volume_of(states, semantic=semantic)
    mesh = mesh_of(volume)
    pose = look_at(np.array([4.0, 4.5, 3.0]), np.array([0.8, 0.8, 0.2]))
    for bit, corner in enumerate(CORNERS):
        cut = without_near_walls(without_ceiling(volume), *corner)
        hidden = 1 << bit | 1 << 4
        kept = (mesh.cuts & hidden) == 0
        kept &= (mesh.cover == 65535) | (mesh.cover >> 8 & hidden > 0)
        rays = rays_of(volume, pose, WIDE)
        shown, told = (first_quads(one, *rays)[0] for one in (some_of(mesh, kept), mesh_of(cut)))
        both = np.isfinite(shown)
        assert np.array_equal(both, np.isfinite(told))
        assert np.allclose(shown[both], told[both], atol=1e-9)
        assert both.sum() > 60


def some_of(mesh, rows):
    values = {name: value for name, value in vars(mesh).items() if name != "atlas"}
    clear_from = int(rows[: values.pop("clear_from")].sum())
    held = {name: value[rows] for name, value in values.items()}
    return BlockMesh(**held, clear_from=clear_from, atlas=mesh.atlas)


def test_faces_are_joined_to_the_same_surface():
    rng = np.random.default_rng(3)
    mask = rng.random((5, 6, 4)) < 0.6
    cells = np.argwhere(mask)
    look = rng.integers(-1, 3, len(cells))
    for side in range(6):
        found = merge_faces(cells, np.full(len(cells), side), look)
        covered = {}
        for first, length in zip(found.first, found.length, strict=True):
            for step in np.ndindex(*length):
                cell = tuple(cells[first] + step)
                assert cell not in covered
                covered[cell] = look[first]
        assert covered == {tuple(c): value for c, value in zip(cells, look, strict=True)}
        assert len(found.first) < len(cells)


def test_light_is_that_of_the_game_where_it_is_open():
    """Under the open sky, in the middle of a floor and where it meets a wall."""
    states = np.zeros((9, 9, 9), int)
    states[:, 0] = 1
    states[0, 1] = 1
    mesh = mesh_of(volume_of(states))
    up = (mesh.position[..., 1] == 1).all(axis=1) & (mesh.position[..., 0].min(axis=1) >= 2)
    assert np.unique(mesh.light[up].reshape(-1, 3), axis=0).tolist() == [[60, 0, 0]]
    by_wall = (mesh.position[..., 1] == 1).all(axis=1) & (mesh.position[..., 0].min(axis=1) == 1)
    assert mesh.light[by_wall, :, 2].max() == 160  # Two of the four cells at such a corner.
