"""Display entities in pictures, against a slow renderer of triangles that reads the NBT itself."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import CAMERA, random_pose, random_volume, slow_picture, volume_of
from scipy.spatial.transform import Rotation

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Entity
from world2minecraft.minecraft.entities import block_display
from world2minecraft.minecraft.nbt import Float
from world2minecraft.rendering import preview, render_parallel, render_volume

RED = "minecraft:red_concrete"


def random_entity(rng: np.random.Generator, volume, number: int) -> Entity:
    """A display of any turn about any axis, as the game's NBT says it."""
    low = np.array(volume.corner)
    place = rng.uniform(low, low + volume.states.shape)
    turns = [Rotation.random(random_state=int(rng.integers(1 << 30))).as_quat() for _ in range(2)]
    nbt = {
        "block_state": {"Name": RED},
        "transformation": {
            "left_rotation": [Float(v) for v in turns[0]],
            "right_rotation": [Float(v) for v in turns[1]],
            "scale": [Float(v) for v in rng.uniform(0.8, 3.5, 3)],
            "translation": [Float(v) for v in rng.uniform(-1, 1, 3)],
        },
        "Rotation": [Float(rng.uniform(-180, 180)), Float(rng.uniform(-90, 90))],
    }
    return Entity(tuple(place.tolist()), "minecraft:block_display", nbt, 5, number)


def triangles_of(entity: Entity) -> np.ndarray:
    """The twelve triangles, float64 [12, 3, 3] in world blocks, of a display of a full cube."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    parts = entity.nbt["transformation"]
    corners = Rotation.from_quat(np.array(parts["right_rotation"])).apply(corners)
    corners = corners * np.array(parts["scale"])
    corners = Rotation.from_quat(np.array(parts["left_rotation"])).apply(corners)
    corners = corners + np.array(parts["translation"])
    yaw, pitch = entity.nbt["Rotation"]
    corners = Rotation.from_euler("YX", [-yaw, pitch], degrees=True).apply(corners)
    corners = corners + entity.position
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    return np.array([corners[[a, b, c]] for f in faces for a, b, c in ((*f[:3],), (f[0], *f[2:]))])


def slow_depth(entity: Entity, volume, camera, pose) -> np.ndarray:
    """z-depth of one display, inf where it is missed or holds the camera, in float64."""
    to_block = np.linalg.inv(volume.block_to_room)
    depth = np.full((camera.height_px, camera.width_px), np.inf)
    origin = to_block[:3, :3] @ pose[:3, 3] + to_block[:3, 3]
    triangles = triangles_of(entity)
    for v in range(camera.height_px):
        for u in range(camera.width_px):
            ray = [(u + 0.5 - camera.cx_px) / camera.fx_px, (v + 0.5 - camera.cy_px) / camera.fy_px]
            way = to_block[:3, :3] @ pose[:3, :3] @ [*ray, 1.0]
            met = sorted(
                t for one in triangles if (t := meet_triangle(one, origin, way)) is not None
            )
            if met and not any(t < 0 for t in met):
                depth[v, u] = met[0]
    return depth


def meet_triangle(corners: np.ndarray, origin: np.ndarray, way: np.ndarray) -> float | None:
    """Where along a ray it meets a triangle."""
    one, two = corners[1] - corners[0], corners[2] - corners[0]
    across = np.cross(way, two)
    volume = one @ across
    if abs(volume) < 1e-15:
        return None
    off = origin - corners[0]
    u = off @ across / volume
    v = way @ np.cross(off, one) / volume
    return float(two @ np.cross(off, one) / volume) if min(u, v, 1 - u - v) >= 0 else None


def test_displays_agree_with_the_slow_reference():
    rng = np.random.default_rng(5)
    small = replace(
        CAMERA, width_px=24, height_px=18, cx_px=12.0, cy_px=9.0, fx_px=16.0, fy_px=16.0
    )
    equal = shown = 0
    for _ in range(4):
        volume = random_volume(rng, share=0.03)
        entities = tuple(random_entity(rng, volume, n) for n in (1, 2, 3))
        pose = random_pose(rng, volume)
        picture = render_volume(replace(volume, entities=entities), small, pose)
        blocks, _ = slow_picture(volume, small, pose)
        layers = [np.where(blocks > 0, blocks, np.inf)]
        layers += [slow_depth(one, volume, small, pose) for one in entities]
        nearest = np.min(layers, axis=0)
        owner = np.argmin(layers, axis=0) * np.isfinite(nearest)
        same = np.isclose(picture.depth_m, np.where(np.isfinite(nearest), nearest, 0), atol=1e-4)
        cubes = np.where(picture.cube_index >= 0, picture.instance, 0)
        equal += (same & (cubes == owner)).sum()
        shown += (owner > 0).sum()
    assert equal >= 0.998 * 4 * 24 * 18
    assert shown > 200


def one_box(yaw_deg: float = 0.0, class_id: int = 5) -> Entity:
    return block_display(
        RED, np.array([-1, 0, -0.5, 1, 0.5, 0.5]), (3.0, 65.0, 1.0), yaw_deg=yaw_deg,
        class_id=class_id, instance=7,
    )  # fmt: skip


def empty_room():
    states = np.zeros((9, 7, 8), np.uint16)
    states[:, 0] = 1
    return volume_of(states, np.where(states > 0, 2, 0).astype(np.uint8))


def test_class_and_object_are_those_of_the_display():
    volume = replace(empty_room(), entities=(one_box(),))
    picture = render_volume(
        volume, CAMERA, look_at(np.array([0.9, 0.2, 1.5]), np.array([0.8, 1.7, 0.4]))
    )
    shown = picture.cube_index >= 0
    assert shown.sum() > 50
    assert set(picture.semantic[shown]) == {5}
    assert set(picture.instance[shown]) == {7}
    assert (picture.block_index[shown] == -1).all()
    assert (picture.semantic[~shown & (picture.block_index >= 0)] == 2).all()


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_a_quarter_turn_by_the_box_is_one_by_the_quaternion(turns):
    pose = look_at(np.array([-0.5, 0.2, 2.5]), np.array([0.8, 1.7, 0.3]))
    exact = render_volume(replace(empty_room(), entities=(one_box(90.0 * turns),)), CAMERA, pose)
    free = one_box(90.0 * turns + 1e-4)
    assert free.nbt["transformation"]["left_rotation"][1] != 0
    near = render_volume(replace(empty_room(), entities=(free,)), CAMERA, pose)
    assert (exact.cube_index == near.cube_index).mean() > 0.999
    assert np.abs(exact.depth_m - near.depth_m).max() < 0.3
    assert np.median(np.abs(exact.depth_m - near.depth_m)) < 1e-5


def test_threads_and_parallel_rays_draw_displays_alike():
    volume = replace(empty_room(), entities=(one_box(25.0),))
    down = np.diag([1.0, -1.0, -1.0, 1.0])
    down[:3, 3] = [0.8, 1.6, 3.0]
    pictures = [render_parallel(volume, 60.0, (90, 120), down, threads=n) for n in (1, 3)]
    for name in ("colour", "depth_m", "cube_index", "semantic"):
        assert np.array_equal(getattr(pictures[0], name), getattr(pictures[1], name))
    area_m2 = (pictures[0].cube_index >= 0).sum() / 60.0**2
    assert area_m2 == pytest.approx(2 * 1 / 16, rel=0.02)
    assert pictures[0].depth_m[pictures[0].cube_index >= 0] == pytest.approx(3.0 - 1.5 / 4)


def test_other_entities_and_broken_ones_draw_nothing():
    position = (3.0, 65.0, 1.0)
    broken = (
        Entity(position, "minecraft:armor_stand"),
        Entity(position, "minecraft:block_display"),
        Entity(position, "minecraft:block_display", {"block_state": {"Name": "NO NAME"}}),
        Entity(position, "minecraft:block_display", {"block_state": "stone"}),
        Entity(
            position,
            "minecraft:block_display",
            {"block_state": {"Name": "stone"}, "transformation": {"scale": [Float(1)]}},
        ),
        Entity(
            position,
            "minecraft:block_display",
            {"block_state": {"Name": "stone"}, "transformation": [Float("nan")] * 16},
        ),
        Entity(
            position,
            "minecraft:block_display",
            {"block_state": {"Name": "stone"}, "transformation": {"scale": [Float(0)] * 3}},
        ),
    )
    pose = look_at(np.array([0.9, 0.2, 1.5]), np.array([0.8, 1.7, 0.4]))
    with_them = render_volume(replace(empty_room(), entities=broken), CAMERA, pose)
    without = render_volume(empty_room(), CAMERA, pose)
    assert np.array_equal(with_them.colour, without.colour)
    assert (with_them.cube_index == -1).all()


def test_a_preview_shows_displays():
    shown = [preview(replace(empty_room(), entities=each), 160, 120) for each in ((), (one_box(),))]
    assert (shown[0] != shown[1]).any(axis=2).sum() > 100
