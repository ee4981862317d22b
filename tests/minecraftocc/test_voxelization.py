"""Cells hold what the renderer draws, and nothing else."""

import label_reference as reference
import numpy as np
import pytest
from label_worlds import PALETTE, designs_of, room_of_things

from world2minecraft.core.coordinates import block_axes_to_grid, block_to_room
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraftocc.labels import voxelization as module
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.minecraftocc.types import FineClass
from world2minecraft.rendering.block_models import BuiltinModels

MARGIN = 2e-4


@pytest.mark.parametrize(("scale", "voxel_m"), [(4.0, 0.08), (2.0, 0.11), (12.5, 0.08), (4, None)])
def test_cells_are_those_of_the_slow_reference(scale, voxel_m):
    volume = room_of_things(scale, share=0.04 if scale == 2.0 else 0.1)
    voxels = voxelize_scene(volume, designs_of(volume), voxel_m=voxel_m)
    assert voxels.voxel_m == (voxel_m or 1 / scale)
    parts = reference.solid_parts(volume, BuiltinModels(16))
    shares = reference.filled(parts, voxels.origin_m, voxels.voxel_m)
    assert set(map(tuple, np.argwhere(voxels.fine > 0).tolist())) == set(shares)
    things = [(8, 7), (11, 9)]
    for cell, owners in shares.items():
        most = max(owners.values())
        allowed = set()
        for owner, share in owners.items():
            if share >= most - MARGIN:
                block = tuple(owner[1:])
                what = (volume.semantic[block], volume.instance[block]) if len(block) == 3 else (
                    things[block[0]]
                )  # fmt: skip
                allowed.add((int(what[0]), int(what[1])))
        assert (int(voxels.labels[cell]), int(voxels.instance[cell])) in allowed


def test_a_fine_class_is_a_block_and_its_design():
    volume = room_of_things()
    codes, names = designs_of(volume)
    voxels = voxelize_scene(volume, (codes, names), voxel_m=None)
    assert voxels.fine_classes[0] == FineClass("minecraft:air")
    assert list(voxels.fine_classes[1:]) == sorted(voxels.fine_classes[1:])
    states, codes = block_axes_to_grid(volume.states), block_axes_to_grid(codes)
    seen = 0
    for cell in np.argwhere((states > 0) & (voxels.fine > 0)):
        fine = voxels.fine_classes[voxels.fine[tuple(cell)]]
        own = FineClass(PALETTE[states[tuple(cell)]].partition("[")[0], names[codes[tuple(cell)]])
        seen += fine == own
    assert seen >= 0.98 * (states > 0).sum() - (states == PALETTE.index("minecraft:barrier")).sum()
    assert FineClass("minecraft:stone", "chair_cafe") in voxels.fine_classes  # A display's.


def test_what_is_not_drawn_is_not_there():
    states = np.zeros((3, 3, 3), np.uint16)
    states[1, 1, 1] = 1
    volume = _plain(states, ("minecraft:air", "minecraft:barrier"))
    assert not voxelize_scene(volume).labels.any()


def test_a_block_without_a_class_is_unknown_and_there():
    states = np.zeros((3, 3, 3), np.uint16)
    states[1, 1, 1] = 1
    volume = _plain(states, ("minecraft:air", "minecraft:stone"))
    voxels = voxelize_scene(volume, voxel_m=None)
    assert np.unique(voxels.labels).tolist() == [0, 255]
    assert (voxels.fine > 0).sum() == 1


def test_a_part_of_a_world_is_the_same_part_of_the_whole():
    volume = room_of_things()
    whole = voxelize_scene(volume)
    part = voxelize_scene(volume, within_m=((0.3, 0.2, -0.1), (1.2, 1.1, 0.9)))
    first = np.round((part.origin_m - whole.origin_m) / 0.08).astype(int)
    here = tuple(slice(a, a + n) for a, n in zip(first, part.labels.shape, strict=True))
    assert np.array_equal(part.labels, whole.labels[here])
    assert np.array_equal(part.fine, whole.fine[here])
    assert part.fine_classes == whole.fine_classes


def test_slabs_do_not_show(monkeypatch):
    volume = room_of_things(seed=3)
    whole = voxelize_scene(volume)
    monkeypatch.setattr(module, "SLAB_CELLS", 5000)
    slabs = voxelize_scene(volume)
    assert np.array_equal(whole.labels, slabs.labels)
    assert np.array_equal(whole.instance, slabs.instance)


def test_cells_lie_on_whole_multiples_of_their_size():
    voxels = voxelize_scene(room_of_things())
    assert np.abs(voxels.origin_m / 0.08 - np.round(voxels.origin_m / 0.08)).max() < 1e-9


def test_quarter_turns_of_a_world_turn_its_cells():
    volume = room_of_things(displays=False)
    turned = BlockVolume(
        states=np.ascontiguousarray(np.rot90(volume.states, 2, axes=(0, 2))),
        palette=tuple(state.replace("facing=east", "facing=west").replace("facing=north",
                      "facing=south") for state in volume.palette),
        semantic=np.ascontiguousarray(np.rot90(volume.semantic, 2, axes=(0, 2))),
        instance=np.ascontiguousarray(np.rot90(volume.instance, 2, axes=(0, 2))),
        corner=volume.corner,
        block_to_room=volume.block_to_room,
    )  # fmt: skip
    here, there = (voxelize_scene(one, voxel_m=None).labels for one in (volume, turned))
    assert np.array_equal(np.rot90(here, 2), there)


def test_errors_say_what_to_do(monkeypatch):
    volume = room_of_things()
    with pytest.raises(UsageError, match=r"voxel_m must be at least 0.01 m, got 0.001"):
        voxelize_scene(volume, voxel_m=0.001)
    monkeypatch.setattr(module, "MAX_CELLS", 1000)
    with pytest.raises(UsageError, match=r"need 0 GB and exceed the limit of 1,000 cells"):
        voxelize_scene(volume)


def _plain(states, palette):
    return BlockVolume(
        states=states,
        palette=palette,
        semantic=np.zeros(states.shape, np.uint8),
        instance=np.zeros(states.shape, np.uint16),
        corner=(0, 64, 0),
        block_to_room=block_to_room(np.zeros(2), 4.0),
    )
