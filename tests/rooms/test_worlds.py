"""Houses as worlds: the same seed gives the same blocks, and every block knows what it is of."""

import numpy as np
import pytest

from world2minecraft.classes import SemanticClass
from world2minecraft.exchange.scene import read_scene
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.minecraft.worlds.world import read_world
from world2minecraft.rooms.worlds import generate_world, write_worlds


@pytest.fixture(scope="module")
def house():
    return generate_world(5, rooms=5, storeys=1)


def test_the_same_seed_gives_the_same_world(house):
    again = generate_world(5, rooms=5, storeys=1)
    assert again.volume.palette == house.volume.palette
    assert np.array_equal(again.volume.states, house.volume.states)
    assert np.array_equal(again.design, house.design)
    assert not np.array_equal(
        generate_world(6, rooms=5, storeys=1).volume.states.shape, house.volume.states.shape
    ) or not np.array_equal(
        generate_world(6, rooms=5, storeys=1).volume.states, house.volume.states
    )


def test_designs_are_of_the_library_and_of_their_class(house):
    assert house.designs[0] == ""
    assert set(house.designs[1:]) <= set(TEMPLATES.names())
    for number, name in enumerate(house.designs[1:], 1):
        own = house.design == number
        assert own.any()
        assert (house.volume.semantic[own] == template(name).class_id).all()
        assert (house.volume.instance[own] > 0).all()
    assert not house.design[house.volume.states == 0].any()


def test_a_house_has_structure_and_furniture(house):
    classes = set(np.unique(house.volume.semantic).tolist())
    wanted = (SemanticClass.FLOOR, SemanticClass.WALL, SemanticClass.CEILING, SemanticClass.WINDOW)
    assert {int(one) for one in wanted} <= classes
    assert len(classes) >= 9
    assert len(house.things) >= 5 * 4


def test_written_worlds_are_read_back(tmp_path):
    (folder,) = write_worlds(tmp_path, 1, 3)
    scene = read_scene(folder)
    assert scene.design is not None
    assert scene.design.shape == scene.semantic.shape
    assert scene.designs[0] == ""
    assert int(scene.design.max()) == len(scene.designs) - 1
    assert set(scene.light) == {"hour", "lamps"}
    volume = read_world(folder / "world")
    assert volume.states.any()


def test_a_scene_without_designs_is_read(tmp_path):
    (folder,) = write_worlds(tmp_path, 1, 3)
    with np.load(folder / "scene.npz") as arrays:
        kept = {name: arrays[name] for name in ("semantic", "instance")}
    np.savez(folder / "scene.npz", **kept)
    assert read_scene(folder).design is None
