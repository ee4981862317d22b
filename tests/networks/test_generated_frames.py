"""Labelled frames of generated rooms: classes of voxels, frames, and files."""

from functools import lru_cache

import numpy as np
import pytest

from world2minecraft.core.errors import InputError
from world2minecraft.core.vocabulary import nyu40_classes, nyu40_names
from world2minecraft.networks.segmentation.frames import IGNORED
from world2minecraft.networks.segmentation.generated import (
    FURNITURE,
    SIZE_PX,
    STRUCTURE,
    generate_frames,
    read_frames,
    voxel_classes,
    write_frames,
)
from world2minecraft.procgen import generate_room

# NYU40 names them and maps them to objects; the generator counts them as furniture.
FITTINGS = {"bathtub", "toilet", "washstand"}


@lru_cache(maxsize=1)
def _room(kind, seed):
    return generate_room(seed, kind=kind, clutter=0.7, shape=None)


@pytest.mark.parametrize(
    ("kind", "seed"), [("kitchen", 0), ("bathroom", 1), ("hall", 2), ("study", 3), ("bed", 4)]
)
def test_voxels_agree_with_the_twelve_classes(kind, seed):
    room = _room(kind, seed)
    found = voxel_classes(room)
    assert found.dtype == np.uint8 and found.shape == room.labels.shape
    names = np.array(["", *(item.name for item in room.objects)])
    is_named = (found != IGNORED) & ~np.isin(names[room.instance], list(FITTINGS))
    mapped = nyu40_classes()[found.astype(int) + 1]
    assert (mapped[is_named] == room.labels[is_named]).all()
    assert (found[room.labels == 0] == IGNORED).all()
    assert is_named[room.labels > 0].mean() > 0.7


def instance_classes(room, number):
    """The NYU40 names of an object of a room, with the heights in metres where each occurs."""
    found = voxel_classes(room)
    names = {number - 1: name for name, number in nyu40_names().items()}
    part = room.instance == number
    heights = np.broadcast_to(
        np.arange(part.shape[2]) * room.voxel_m + room.origin_m[2], part.shape
    )
    return {names[n]: heights[part & (found == n)] for n in np.unique(found[part])}


@pytest.mark.parametrize(
    ("kind", "seed", "item", "top", "begin_m"),
    [
        ("kitchen", 0, "counter", "counter", 0.86),
        ("kitchen", 0, "sink_counter", "counter", 0.86),
        ("bathroom", 1, "washstand", "sink", 0.74),
    ],
)
def test_tops_have_a_class_of_their_own(kind, seed, item, top, begin_m):
    room = _room(kind, seed)
    number = next(n for n, one in enumerate(room.objects, 1) if one.name == item)
    parts = instance_classes(room, number)
    assert set(parts) == {"cabinet", top}
    assert parts["cabinet"].max() == pytest.approx(begin_m - room.voxel_m)
    assert parts[top].min() == pytest.approx(begin_m)
    # The whole slab is there, and not the tap alone.
    assert (parts[top] < begin_m + 0.03).sum() > 300


def test_all_names_are_classes_of_nyu40():
    assert set(FURNITURE.values()) | set(STRUCTURE.values()) <= set(nyu40_names())


@pytest.fixture(scope="module")
def frames():
    return list(generate_frames([200_005], 2))


def test_frames_of_a_seed_show_the_room(frames):
    assert [frame.name for frame in frames] == ["200005-0", "200005-1"]
    for frame in frames:
        assert frame.colour.shape == (*SIZE_PX[::-1], 3)
        assert frame.labels.shape == SIZE_PX[::-1]
        assert len(np.unique(frame.labels)) > 3
        assert (frame.depth_m > 0.1).mean() > 0.9


def test_frames_of_a_seed_are_the_same(frames):
    again = next(iter(generate_frames([200_005], 2)))
    for name in ("colour", "labels", "depth_m"):
        assert (getattr(again, name) == getattr(frames[0], name)).all()


def test_written_frames_come_back(frames, tmp_path):
    assert write_frames(tmp_path / "rooms", frames) == 2
    read = read_frames(tmp_path / "rooms")
    for before, after in zip(frames, read, strict=True):
        assert (after.name, after.camera) == (before.name, before.camera)
        assert (after.labels == before.labels).all()
        assert np.abs(after.depth_m - before.depth_m).max() <= 0.5e-3 + 1e-6
        assert np.abs(after.colour.astype(int) - before.colour).mean() < 4


def test_folder_without_generated_frames_is_named(tmp_path):
    with pytest.raises(InputError, match=r"NAME\.label40\.png"):
        read_frames(tmp_path)
