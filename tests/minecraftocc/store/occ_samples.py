"""Small samples with all that a sample can hold, made of a seed."""

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.types import FineClass, LabelRegion, OccLabels, OccSample

AIR = FineClass("minecraft:air")
PLANKS = FineClass("minecraft:oak_planks")
CHAIR = FineClass("minecraft:oak_stairs", "chair_cafe")
SHAPE = (5, 4, 3)
CAMERA = Camera(16, 12, 10.0, 10.0, 8.0, 6.0)


def sample(
    seed=0, scene="house_0001", split="train", pictures=True, classes=(AIR, PLANKS, CHAIR)
) -> OccSample:
    rng = np.random.default_rng(seed)
    pose = np.eye(4)
    pose[:3, 3] = rng.uniform(-2, 2, 3)
    depth = rng.uniform(0.001, 60, (12, 16))
    depth[0, :3] = 0
    fine = rng.integers(0, len(classes), SHAPE).astype(np.uint16)
    labels = np.where(fine > 0, rng.choice([2, 5, 11], SHAPE), 0).astype(np.uint8)
    labels[0, 0, 0] = 255
    return OccSample(
        key=f"{scene}-a-{seed:06d}",
        scene_id=scene,
        tour_id="a",
        frame=seed,
        camera=CAMERA,
        camera_to_room=pose,
        occ=OccLabels(
            LabelRegion(SHAPE, 0.08, np.eye(4), "axis"),
            labels,
            fine,
            rng.integers(0, 999, SHAPE).astype(np.uint16),
            rng.random(SHAPE) < 0.6,
            (rng.integers(0, 70_000, SHAPE) * (rng.random(SHAPE) < 0.3)).astype(np.uint32),
            rng.random(SHAPE) < 0.3,
        ),
        fine_classes=tuple(classes),
        colour=rng.integers(0, 256, (12, 16, 3)).astype(np.uint8) if pictures else None,
        depth_m=(np.rint(depth * 1000) / 1000).astype(np.float32) if pictures else None,
        split=split,
        facts={"block_to_room": np.diag([0.25, 0.25, 0.25, 1.0]).tolist(), "game_pose": POSE},
    )


POSE = {"x": 1.5, "y": 65.62, "z": -3.25, "yaw": 90.0, "pitch": 5.0}


def samples(count=7, scenes=("house_0001", "house_0002"), **words):
    for number, scene in enumerate(scenes):
        split = "test" if number else "train"
        for n in range(count):
            yield sample(100 * number + n, scene, split, **words)


def assert_same(ours: OccSample, theirs: OccSample, colour=True):
    """All of a sample, but for colours that JPEG has changed, and the numbers of fine classes."""
    for name in ("key", "scene_id", "tour_id", "frame", "split", "facts"):
        assert getattr(ours, name) == getattr(theirs, name)
    assert ours.camera_to_room.tolist() == theirs.camera_to_room.tolist()
    assert vars(ours.camera).keys() == vars(theirs.camera).keys()
    assert ours.camera.fx_px == theirs.camera.fx_px
    for name in ("labels", "instance", "in_frustum", "hits", "free"):
        mine, other = getattr(ours.occ, name), getattr(theirs.occ, name)
        assert mine.dtype == other.dtype
        np.testing.assert_array_equal(mine, other)
    for name in ("shape", "voxel_m", "kind"):
        assert getattr(ours.occ.region, name) == getattr(theirs.occ.region, name)
    mine = [ours.fine_classes[n] for n in ours.occ.fine.reshape(-1)]
    assert mine == [theirs.fine_classes[n] for n in theirs.occ.fine.reshape(-1)]
    if ours.depth_m is None:
        assert theirs.depth_m is None and theirs.colour is None
        return
    np.testing.assert_array_equal(ours.depth_m, theirs.depth_m)
    if colour:
        np.testing.assert_array_equal(ours.colour, theirs.colour)
