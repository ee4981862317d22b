"""Samples of data sets, made up cell by cell."""

import numpy as np

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.types import FineClass, LabelRegion, OccLabels, OccSample

FINE = (
    FineClass("minecraft:air"),
    FineClass("minecraft:oak_planks"),
    FineClass("minecraft:oak_stairs", "chair_cafe"),
    FineClass("minecraft:spruce_stairs", "chair_cafe"),
    FineClass("minecraft:white_wool"),
)
CAMERA = Camera(640, 480, 500.0, 500.0, 320.0, 240.0)


def occ_labels(shape=(6, 5, 4), *, at_m=(0.0, 0.0, 0.0), turn_deg=0.0, voxel_m=0.5):
    """Empty labels of a small region, all in the frustum."""
    region_to_room = rotation_about_z(turn_deg)
    region_to_room[:3, 3] = at_m
    return OccLabels(
        LabelRegion(shape, voxel_m, region_to_room),
        np.zeros(shape, np.uint8),
        np.zeros(shape, np.uint16),
        np.zeros(shape, np.uint16),
        np.ones(shape, bool),
        np.zeros(shape, np.uint32),
        np.zeros(shape, bool),
    )


def sample(number=0, scene="house_0001", occ=None, split="train", colour=None, camera=CAMERA):
    """A sample of made-up labels."""
    pose = np.eye(4)
    return OccSample(
        key=f"{scene}-tour_1-{number:04d}",
        scene_id=scene,
        tour_id="tour_1",
        frame=number,
        camera=camera,
        camera_to_room=pose,
        occ=occ or random_labels(number),
        fine_classes=FINE,
        colour=colour,
        split=split,
    )


def random_labels(seed, shape=(6, 5, 4), **place):
    """Labels of which a third of the cells are occupied, some unknown, some out of the frustum."""
    rng = np.random.default_rng(seed)
    empty = occ_labels(shape, **place)
    labels = np.where(rng.random(shape) < 0.35, rng.integers(1, 12, shape), 0).astype(np.uint8)
    labels[rng.random(shape) < 0.05] = 255
    solid = (labels > 0) & (labels < 255)
    fine = np.where(solid, rng.integers(1, len(FINE), shape), 0).astype(np.uint16)
    hits = np.where(solid & (rng.random(shape) < 0.6), rng.integers(1, 90, shape), 0)
    return OccLabels(
        empty.region,
        labels,
        fine,
        empty.instance,
        rng.random(shape) < 0.8,
        hits.astype(np.uint32),
        (labels == 0) & (rng.random(shape) < 0.5),
    )
