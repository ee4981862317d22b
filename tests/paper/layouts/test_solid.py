"""What is solid of a layout's things: tucked chairs are none, chairs in beds are collisions."""

import numpy as np
import pytest

from world2minecraft.core.types import Layout, Placement
from world2minecraft.furniture.solid_parts import solids_m
from world2minecraft.paper.layouts import ComparedScene, score_scene
from world2minecraft.paper.layouts.importers.value_checks import Box, object_of
from world2minecraft.paper.layouts.scores import solid_collisions, solid_parts

ROOM = Layout([[0, 0], [4, 0], [4, 3], [0, 3]], 2.6)
TABLE = ("dining_table", (2.0, 1.5, 0.375), (0.9, 1.6, 0.75), 0.0)


def thing(name, center, size, yaw=0.0):
    return object_of(Box(name, center, size, yaw))


def scene(*objects, **more):
    return ComparedScene("room", "method", (ROOM,), objects, **more)


@pytest.mark.parametrize("quarters", range(4))
@pytest.mark.parametrize("name", ["chair", "double_bed", "desk", "bookshelf"])
def test_parts_are_those_of_the_placement_that_is_built(name, quarters):
    size = {"chair": (0.5, 0.48, 0.9), "double_bed": (2.0, 1.6, 0.9)}.get(name, (0.4, 1.2, 0.8))
    item = thing(name, (1.5, 1.0, size[2] / 2), size, 90.0 * quarters)
    template = {"bookshelf": "bookcase"}.get(name, name)
    placed = Placement(1, item.class_id, template, item.center_m, item.size_m, quarters, 1.0)
    told = sorted(np.round(box, 6).ravel().tolist() for box in solids_m(placed))
    found = []
    for part in solid_parts(item):
        sides = part.size_m[[1, 0, 2]] if quarters % 2 else part.size_m
        found.append([*(part.center_m - sides / 2), *(part.center_m + sides / 2)])
    assert np.allclose(sorted(np.round(found, 6).tolist()), told, atol=1e-5)


@pytest.mark.parametrize(("yaw", "met"), [(90.0, 0), (270.0, 1)])
def test_tucked_chair_is_clear_its_back_through_top_is_not(yaw, met):
    room = scene(thing(*TABLE), thing("chair", (2.0, 0.62, 0.44), (0.45, 0.45, 0.88), yaw))
    assert len(score_scene(room).colliding) == 1
    assert solid_collisions(room) == met


def test_a_chair_within_a_bed_collides_by_any_rule():
    room = scene(thing("double_bed", (1.2, 1.5, 0.3), (2.0, 1.6, 0.6)),
                 thing("chair", (1.2, 1.5, 0.44), (0.45, 0.45, 0.88)))  # fmt: skip
    told = score_scene(room)
    assert told.collided == 1 and told.colliding == ((0, 1),)


def test_what_no_design_stands_for_is_solid_all_through():
    lump = thing("samovar", (1, 1, 0.5), (1, 1, 1))
    assert solid_parts(lump) == [lump]
    assert solid_collisions(scene(lump, thing("samovar", (1.5, 1, 0.5), (1, 1, 1)))) == 1


def test_a_run_knows_its_own_count():
    assert solid_collisions(scene(collided=3)) == 3
