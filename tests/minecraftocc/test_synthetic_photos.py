"""Photo-like sets: a room's own voxels as cells, labels that fit the pictures, splits by room."""

import numpy as np
import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.core.errors import UsageError, World2MinecraftError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc import synthetic_photos as photo_rooms
from world2minecraft.minecraftocc.sample_figure import share_of_depth_in_cells
from world2minecraft.minecraftocc.store import open_store
from world2minecraft.minecraftocc.synthetic_photos import PhotoRooms, photo_samples, voxelize_room
from world2minecraft.procgen import generate_room

CAMERA = Camera(160, 120, 129.7, 129.7, 80.0, 60.0)


@pytest.fixture(scope="module")
def samples():
    return list(photo_samples(PhotoRooms(3, 7, 0.3, 1, CAMERA)))


def test_cells_are_occupied_where_four_of_64_voxels_are():
    room = generate_room(7, kind="bed")
    voxels = voxelize_room(room)
    assert np.allclose(voxels.origin_m / 0.08, np.round(voxels.origin_m / 0.08))
    offset = np.round((room.origin_m - voxels.origin_m) / 0.02).astype(int)
    rng = np.random.default_rng(0)
    for cell in rng.integers(0, voxels.labels.shape, (400, 3)):
        low = cell * 4 - offset
        box = tuple(
            slice(max(at, 0), max(min(at + 4, side), 0))
            for at, side in zip(low, room.labels.shape, strict=True)
        )
        held = room.labels[box][room.labels[box] > 0]
        label = voxels.labels[tuple(cell)]
        assert (label > 0) == (held.size >= 4)
        if label:
            counts = np.bincount(held, minlength=12)
            assert counts[label] == counts.max()


def test_cells_are_whole_voxels():
    with pytest.raises(UsageError, match="a multiple of 0.02 m, got 0.05"):
        voxelize_room(generate_room(7, kind="bed"), 0.05)


def test_labels_fit_the_pictures(samples):
    for sample in samples:
        # A cell that less than a sixteenth of a surface reaches into is empty by the rule.
        assert share_of_depth_in_cells(sample) > 0.95
        assert sample.colour.std() > 10
        assert {2, 3} & set(np.unique(sample.occ.labels[sample.occ.visible]))
        assert sample.occ.free.any() and not (sample.occ.free & sample.occ.occupied).any()


def test_another_kind_of_room_is_tried_where_one_fails(monkeypatch):
    asked = []

    def reluctant(seed, kind, **words):
        asked.append(kind)
        if len(asked) == 1:
            raise World2MinecraftError(f"seed {seed} gives no {kind} room; try another seed")
        return generate_room(seed, kind=kind, **words)

    monkeypatch.setattr(photo_rooms, "generate_room", reluctant)
    (sample,) = photo_samples(PhotoRooms(1, 1, 0, 2, CAMERA))
    assert sample.facts["room"]["kind"] == asked[1] != asked[0]

    def unable(seed, kind, **words):
        raise World2MinecraftError("no")

    monkeypatch.setattr(photo_rooms, "generate_room", unable)
    with pytest.raises(UsageError, match="no room can be generated with seed 42000"):
        next(photo_samples(PhotoRooms(1, 1, 0, 2, CAMERA)))


def test_rooms_are_of_one_split_and_share_the_pictures(samples):
    assert len(samples) == 7 and len({one.key for one in samples}) == 7
    splits = {one.scene_id: one.split for one in samples}
    assert list(splits.values()) == ["train", "train", "test"]
    assert [list(one.scene_id for one in samples).count(name) for name in splits] == [3, 2, 2]


def test_the_same_seed_gives_the_same_set(samples):
    again = next(photo_samples(PhotoRooms(3, 7, 0.3, 1, CAMERA)))
    np.testing.assert_array_equal(again.colour, samples[0].colour)
    np.testing.assert_array_equal(again.occ.labels, samples[0].occ.labels)
    other = next(photo_samples(PhotoRooms(3, 7, 0.3, 2, CAMERA)))
    assert not np.array_equal(other.colour, samples[0].colour)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ((0, 5), "rooms must be from 1 to 1000, got 0"),
        ((5, 3), "images must be at least 5, one per room, got 3"),
        ((1, 3, 0.5), "--test-share 0.5 leaves no room for training"),
    ],
)
def test_a_plan_that_cannot_be_is_refused(words, text):
    with pytest.raises(UsageError, match=text):
        PhotoRooms(*words)


def test_the_verb_writes_a_store(tmp_path, capsys):
    words = ["dataset", "rooms", tmp_path / "P", "--rooms", 2, "--images", 2, "--size", "160x120"]
    assert w2m([str(word) for word in [*words, "--test-share", 0.5]]) == 0
    assert "next: w2m dataset show" in capsys.readouterr().out
    store = open_store(tmp_path / "P")
    assert sorted(store.index()["split"].tolist()) == ["test", "train"]
