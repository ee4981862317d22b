"""A layout stands in its cells as it was told: turned, in its box, with its faults."""

import numpy as np
import pytest

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Layout, Placement
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.paper.layouts import ComparedScene
from world2minecraft.paper.layouts.furniture_lookup import design_of, designs
from world2minecraft.paper.layouts.importers.value_checks import Box, object_of
from world2minecraft.paper.layouts.layout_to_world import plan_of
from world2minecraft.paper.layouts.scene_selection import folder_names, select_scenes
from world2minecraft.reconstruction.floorplans.plan_grid import rasterize_plan

ROOM = Layout([[0, 0], [4, 0], [4, 3], [0, 3]], 2.6)


def thing(name, center, size, yaw=0.0):
    return object_of(Box(name, center, size, yaw))


def scene(*objects, name="room", rooms=(ROOM,)):
    return ComparedScene(name, "method", rooms, objects)


BED = thing("double_bed", (1.0, 1.5, 0.25), (2.0, 1.6, 0.5), 0.0)
CHAIR = thing("chair", (3.4, 1.5, 0.45), (0.5, 0.48, 0.9), 180.0)


def test_every_design_is_in_the_library():
    for word, (name, _) in designs().items():
        assert name in TEMPLATES.names(), word
        assert template(name).name == name


@pytest.mark.parametrize(
    ("name", "size", "expected"),
    [
        ("double_bed", (2, 1.6, 0.5), "double_bed"),
        ("children_cabinet", (0.5, 0.9, 0.9), "cabinet"),
        ("tv_stand", (0.4, 1.6, 0.5), "tv_stand"),
        ("pendant_lamp", (0.4, 0.4, 0.8), "pendant_lamp"),
        ("queen_bed_2", (2, 1.6, 0.5), "double_bed"),
        ("lazy_seat", (0.8, 0.8, 0.9), "armchair"),
        ("samovar", (0.3, 0.3, 0.5), "cells"),
    ],
)
def test_a_name_or_else_a_class_finds_what_stands_for_a_thing(name, size, expected):
    assert design_of(thing(name, (1, 1, size[2] / 2), size)).template == expected


def test_things_stand_in_their_boxes_and_face_as_stated():
    held = rasterize_plan(plan_of(scene(BED, CHAIR)))
    bed, chair = held.placements
    assert (bed.class_id, bed.template) == (int(SemanticClass.BED), "double_bed")
    assert (chair.template, chair.quarter_turns) == ("chair", 2)
    for placed, told in ((bed, BED), (chair, CHAIR)):
        assert placed.center_m[:2] == pytest.approx(told.center_m[:2], abs=0.09)
        assert placed.size_m == pytest.approx(told.size_m, abs=0.09)
    floor = held.grid.labels == SemanticClass.FLOOR
    area = floor.any(axis=2).sum() * held.grid.voxel_m**2
    assert area == pytest.approx(12.0, rel=0.05)


def test_a_front_that_looks_at_a_wall_is_left_so():
    """A plan of an app is judged there; a layout is shown with its faults."""
    wrong = thing("wardrobe", (0.3, 1.5, 1.0), (0.6, 1.2, 2.0), 180.0)
    (placed,) = rasterize_plan(plan_of(scene(wrong))).placements
    assert placed.quarter_turns == 2


def test_things_in_walls_are_cut_and_larger_ones_stay():
    out = thing("desk", (4.3, 1.5, 0.37), (1.2, 1.2, 0.74))
    held = rasterize_plan(plan_of(scene(out)))
    cells = np.argwhere(held.grid.instance == 1) * 0.08 + held.grid.origin_m
    assert len(cells) and cells[:, 0].max() < 4.0
    small = thing("chair", (1.0, 1.5, 0.45), (0.5, 0.5, 0.9))
    both = rasterize_plan(plan_of(scene(small, BED)))
    assert both.placements[0].template == "double_bed"


def test_each_thing_is_in_the_room_that_it_stands_in():
    other = Layout([[5, 0], [8, 0], [8, 3], [5, 3]], 2.6)
    far = thing("desk", (6.5, 1.5, 0.37), (0.7, 1.2, 0.74))
    lost = thing("desk", (20, 1.5, 0.37), (0.7, 1.2, 0.74))
    first, second = plan_of(scene(BED, far, lost, rooms=(ROOM, other))).rooms
    assert [item.design for item in first.objects] == ["double_bed", "desk"]
    assert [item.design for item in second.objects] == ["desk"]
    assert len(first.walls) == 4 and first.floors[0].shape == (4, 3)


def test_a_run_has_its_world_already():
    placed = Placement(1, int(SemanticClass.BED), "double_bed", BED.center_m, BED.size_m, 0, 0.9)
    with pytest.raises(UsageError, match="is a finished run that already has a world"):
        plan_of(scene(placed))


def test_scenes_are_chosen_by_name_or_count():
    found = [scene(BED, name=f"Bedroom-{n}") for n in range(3)]
    assert [one.name for one in select_scenes(found, [], None)] == ["Bedroom-0"]
    assert len(select_scenes(found, [], 2)) == 2
    assert [one.name for one in select_scenes(found, ["m-2"], None)] == ["Bedroom-2"]
    with pytest.raises(UnknownNameError, match="no scene is named 'Bedrom-1'; did you mean"):
        select_scenes(found, ["Bedrom-1"], None)


def test_names_of_others_become_plain_folders():
    names = ["a/../b", "..", "room", "room", "", "é" * 9]
    told = folder_names([scene(BED, name=name or " ") for name in names])
    assert len(set(told)) == len(told)
    assert all(name and name not in (".", "..") and "/" not in name for name in told)
    assert told[2:4] == ["room", "room_3"]


def test_a_numbered_folder_does_not_take_the_name_of_another():
    told = folder_names([scene(BED, name=name) for name in ("room", "room_2", "room")])
    assert told == ["room", "room_2", "room_2_2"]
