"""Labelled photo-like images of generated rooms, as a substitute for labelled photos.

The 2 cm voxels of a room are the ground truth. They are downsampled to 8 cm cells with SSCNet's
rule, as in NYUv2, and images are then labelled in the same way as images of block worlds: with the
paper's region and with masks computed from the depth. The images imitate a phone camera: surface
textures, soft edges, exposure and sensor noise. The depth is exact.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import UsageError, World2MinecraftError
from world2minecraft.core.types import Camera
from world2minecraft.formats.sscnet import downsample_labels
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA
from world2minecraft.minecraftocc.labels.camera_region import region_in
from world2minecraft.minecraftocc.labels.image_labels import label_image
from world2minecraft.minecraftocc.types import DEFAULT_VOXEL_M, FineClass, OccSample, SceneVoxels
from world2minecraft.procgen import Room, generate_room
from world2minecraft.procgen.rooms.recipes import KINDS
from world2minecraft.procgen.sensors.photo_rendering import (
    TexturedScene,
    develop,
    expose,
    prepare_textured,
)
from world2minecraft.procgen.sensors.trajectory import plan_trajectory
from world2minecraft.rendering.voxel_camera import cast_voxels

FIRST_SEED = 40_000  # Of rooms. The seeds of benchmarks and other data sets are lower.
ROOMS_PER_SEED = 1_000
MAX_CLUTTER = 0.8
FINE_CLASSES = (
    FineClass("minecraft:air"),
    *(FineClass(f"room:{name}") for name in CLASS_NAMES[1:]),
)


@dataclass(frozen=True)
class PhotoRooms:
    """The rooms to render for a synthetic photo data set, and the number of images.

    Attributes:
        rooms: Number of rooms to generate.
        images: Total number of images.
        test_share: Fraction of the rooms to use for testing; the last rooms are used.
        seed: Random seed.
        camera: Camera of the images.

    Raises:
        UsageError: If fewer images than rooms are requested, or if no room is left for training.
    """

    rooms: int = 20
    images: int = 400
    test_share: float = 0.25
    seed: int = 0
    camera: Camera = NYU_CAMERA

    def __post_init__(self):
        if not 1 <= self.rooms <= ROOMS_PER_SEED:
            raise UsageError(f"rooms must be from 1 to {ROOMS_PER_SEED}, got {self.rooms}")
        if self.images < self.rooms:
            raise UsageError(
                f"images must be at least {self.rooms}, one per room, got {self.images}"
            )
        if not 0 <= self.test_share < 1 or self.test_rooms >= self.rooms:
            raise UsageError(
                f"--test-share {self.test_share:g} leaves no room for training; choose a "
                "smaller value"
            )

    @property
    def test_rooms(self) -> int:
        """Number of rooms used for testing."""
        return max(1, round(self.test_share * self.rooms)) if self.test_share else 0

    def images_of(self, number: int) -> int:
        """Return the number of images of a room, which differs by at most one between rooms."""
        return self.images // self.rooms + (number < self.images % self.rooms)


def photo_samples(plan: PhotoRooms) -> Iterator[OccSample]:
    """Generate the samples room by room, yielding one at a time."""
    for number in range(plan.rooms):
        is_test = number >= plan.rooms - plan.test_rooms
        room = _room(plan, number)
        yield from _of_room(plan, number, room, "test" if is_test else "train")


def voxelize_room(room: Room, voxel_m: float = DEFAULT_VOXEL_M) -> SceneVoxels:
    """Downsample the voxels of a room to larger cells with SSCNet's rule, as in NYUv2.

    The resulting cells have no object numbers.

    Args:
        room: Room or house.
        voxel_m: Cell size in metres. Must be a multiple of the voxel size of the room.

    Raises:
        UsageError: If the cell size is not a multiple of the voxel size.
    """
    factor = round(voxel_m / room.voxel_m)
    if factor < 1 or abs(factor * room.voxel_m - voxel_m) > 1e-9:
        raise UsageError(f"voxel_m must be a multiple of {room.voxel_m:g} m, got {voxel_m:g}")
    first = np.round(room.origin_m / room.voxel_m).astype(int)
    before = first % factor
    after = -(before + room.labels.shape) % factor
    padded = np.pad(room.labels, list(zip(before, after, strict=True)))
    labels = downsample_labels(padded, factor)
    return SceneVoxels(
        labels=labels,
        fine=labels.astype(np.uint16),
        instance=np.zeros(labels.shape, np.uint16),
        fine_classes=FINE_CLASSES,
        voxel_m=voxel_m,
        origin_m=(first - before) * room.voxel_m,
    )


def _room(plan: PhotoRooms, number: int) -> Room:
    """Generate a room of random kind, shape and clutter, trying the next kind if one fails."""
    seed = FIRST_SEED + ROOMS_PER_SEED * plan.seed + number
    clutter = float(np.random.default_rng([seed, 5]).uniform(0, MAX_CLUTTER))
    kinds = sorted(KINDS)
    turn = seed % len(kinds)
    for kind in (*kinds[turn:], *kinds[:turn]):
        with suppress(World2MinecraftError):  # The furniture of this kind does not fit.
            return generate_room(seed, kind=kind, clutter=clutter, shape=None)
    raise UsageError(f"no room can be generated with seed {seed}; choose another seed (--seed)")


def _of_room(plan: PhotoRooms, number: int, room: Room, split: str) -> Iterator[OccSample]:
    scene, voxels = prepare_textured(room), voxelize_room(room)
    rng = np.random.default_rng([room.seed, 6])
    images = plan.images_of(number)
    poses = plan_trajectory(room, scene.photos.scene, plan.camera, images, rng)
    for frame, pose in enumerate(poses):
        yield _sample(plan, number, room, scene, voxels, pose, frame, split)


def _sample(
    plan: PhotoRooms,
    number: int,
    room: Room,
    scene: TexturedScene,
    voxels: SceneVoxels,
    pose: np.ndarray,
    frame: int,
    split: str,
) -> OccSample:
    light = expose(scene, plan.camera, pose[None])
    colour = develop(light, np.random.default_rng([room.seed, 7, frame]))
    depth_m = cast_voxels(scene.photos.scene, plan.camera, pose).depth_m
    region = region_in(voxels, pose)
    scene_id = f"photo_{plan.seed}_{number:04d}"
    return OccSample(
        key=f"{scene_id}-walk-{frame:06d}",
        scene_id=scene_id,
        tour_id="walk",
        frame=frame,
        camera=plan.camera,
        camera_to_room=pose,
        occ=label_image(voxels, region, plan.camera, pose, depth_m),
        fine_classes=FINE_CLASSES,
        colour=colour,
        depth_m=depth_m,
        split=split,
        facts={"room": {"kind": room.kind, "seed": room.seed}, "tier": "photo"},
    )
