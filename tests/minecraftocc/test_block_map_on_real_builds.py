"""Builds of other people: what a block map makes of them."""

import numpy as np
import pytest
from house_of_blocks import Blocks, cottage

from world2minecraft.core.classes import CLASS_NAMES, class_id
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraft.file_format import WriteOptions
from world2minecraft.minecraft.formats import write_blocks
from world2minecraft.minecraftocc.scene_sources import open_scene_source

MODERN = ("modern_apartment", "modern_cottage", "modern_library", "modern_restaurant")
EMPTY_BLOCKS = ("air", "water", "barrier", "light", "structure_void")


@pytest.fixture
def build_of(shared_data):
    folder = shared_data / "mcprefab_builds"
    if not folder.is_dir():
        pytest.skip(f"the builds of MC-Prefab are not at {folder}")
    return lambda name: open_scene_source(folder / f"{name}.schem").volume()


def shares(volume):
    counts = np.bincount(volume.semantic[volume.states > 0], minlength=len(CLASS_NAMES))
    return dict(zip(CLASS_NAMES, counts / counts.sum(), strict=True))


@pytest.mark.parametrize("name", MODERN)
def test_real_builds_have_rooms_and_every_block_a_class(build_of, name):
    volume = build_of(name)
    found = shares(volume)
    assert found["floor"] > 0.1 and found["wall"] > 0.1 and found["ceiling"] > 0.01
    assert found["window"] > 0.005
    shown = [state.partition("[")[0].partition(":")[2] not in EMPTY_BLOCKS
             for state in volume.palette]  # fmt: skip
    assert (volume.semantic[np.array(shown)[volume.states]] > 0).all()


def test_a_restaurant_has_many_benches_and_tables(build_of):
    """Its tables are fences with trapdoors or slabs, its benches stairs in rows."""
    volume = build_of("modern_restaurant")
    for name, least in (("sofa", 10), ("table", 15)):
        parts, count = label_components(volume.semantic == class_id(name), corners=False)
        low = np.array([np.argwhere(parts == n)[:, 1].min() for n in range(1, count + 1)])
        assert (low == 1).sum() >= least


def test_a_library_has_shelves(build_of):
    volume = build_of("modern_library")
    shelf = [state.startswith("minecraft:bookshelf") for state in volume.palette]
    assert (volume.semantic[np.array(shelf)[volume.states]] == class_id("furn")).all()


def test_a_house_in_the_country_is_found_and_its_ground_is_floor(tmp_path):
    """A landscape of 96 x 96 blocks with trees and ore, the cottage away from the spawn."""
    rng = np.random.default_rng(2)
    made = Blocks(96, 24, 96)
    made.put(np.s_[:, :8], "minecraft:stone")
    made.put(np.s_[:, 5:7], "minecraft:dirt")
    made.put(np.s_[:, 7], "minecraft:grass_block[snowy=false]")
    for x, z in rng.integers(0, 96, (30, 2)).tolist():
        made.put((x, slice(8, 12), z), "minecraft:oak_log[axis=y]")
        made.put((x, 12, z), "minecraft:oak_leaves")
        made.put((x, rng.integers(0, 5), z), "minecraft:coal_ore")
    home = cottage()
    own = np.where(home.states > 0, home.states + len(made.palette) - 1, 0)
    made.palette += home.palette[1:]
    made.states[40:52, 8:15, 60:70] = own[:, 1:]
    write_blocks(made.volume(), tmp_path / "country", WriteOptions(spawn=(8, 70, 8)))
    source = open_scene_source(tmp_path / "country")
    volume = source.volume()
    assert "using the detected buildings" in source.notes()[0]
    x, y, z = (a - b for a, b in zip((40, 67, 60), volume.corner, strict=True))
    assert min(x, y, z) >= 0
    told = volume.semantic[x : x + 12, y : y + 8, z : z + 10]
    assert (told[2:10, 1, 2:8] == class_id("floor")).all()
    assert (told[2:10, 5, 2:8] == class_id("ceiling")).all()
    names = {CLASS_NAMES[n] for n in np.unique(told)}
    assert names >= {"wall", "window", "chair", "sofa", "table", "bed", "furn", "objs"}
    grass = volume.states == volume.palette.index("minecraft:grass_block[snowy=false]")
    assert (volume.semantic[grass] == class_id("floor")).mean() > 0.95
