"""A plan alone becomes a world, and beside a scan it says what cells are."""

import json
from dataclasses import replace

import numpy as np
import pytest
from test_plan_grid import layout

from roomplans import captured_room, session_of
from world2minecraft import cli, load
from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
from world2minecraft.cli.reconstruct import print_run
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.progress import no_progress
from world2minecraft.core.types import OWN_CELLS, FusedEvidence
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.formats.roomplan import PlanObject
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.floorplans import (
    PlanMismatchError,
    align_plan,
    build_plan,
    layouts_of,
    merge_plan_openings,
    plan_votes,
    read_roomplan,
    straighten_plan,
)
from world2minecraft.reconstruction.floorplans.furniture_categories import template_of
from world2minecraft.reconstruction.floorplans.plan_grid import rasterize_plan
from world2minecraft.reconstruction.floorplans.room_outlines import move_plan
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.runs import run_plan

SESSION = session_of(21.0, (3.0, -1.4, 0.7))


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    path = tmp_path_factory.mktemp("plan") / "Room.json"
    path.write_text(json.dumps(captured_room(layout(), SESSION)))
    return path


@pytest.fixture(scope="module")
def plan(place):
    return straighten_plan(read_roomplan(place))


@pytest.fixture(scope="module")
def held(plan):
    return rasterize_plan(plan)


def area_m2(grid, kind):
    return int((grid.labels == kind).any(axis=2).sum()) * grid.voxel_m**2


def test_a_plan_becomes_cells(held):
    grid = held.grid
    assert area_m2(grid, SemanticClass.FLOOR) == pytest.approx(4 * 3.2 - 1.5 * 1.2, rel=0.03)
    assert area_m2(grid, SemanticClass.CEILING) == area_m2(grid, SemanticClass.FLOOR)
    window = (grid.labels == SemanticClass.WINDOW).sum() * grid.voxel_m**3
    assert window == pytest.approx(1.0 * 1.2 * grid.voxel_m, rel=0.15)
    floor = np.argwhere(grid.labels == SemanticClass.FLOOR)[:, 2]
    assert set((grid.origin_m[2] + (floor + 1) * grid.voxel_m).round(6)) == {0.0}


def test_no_way_leads_out_of_a_room_but_by_its_doorway(held):
    """All cells around its air are known, but for those of the one doorway."""
    labels = held.grid.labels
    air = labels == 0
    open_to = np.zeros_like(air)
    for axis in range(3):
        for step in (-1, 1):
            open_to |= np.roll(air, step, axis) & (labels == 255)
    columns = np.argwhere(open_to.any(axis=2))
    assert len(columns)
    assert (np.ptp(columns, axis=0) + 1).min() <= 1
    assert (np.ptp(columns, axis=0) + 1).max() * held.grid.voxel_m == pytest.approx(1.0, abs=0.1)


def test_things_stand_in_their_boxes_with_their_fronts(plan, held):
    items = plan.rooms[0].objects
    placed = {one.template: one for one in held.placements}
    assert set(placed) == {"sofa", "dining_table", "chair", "cells"}
    for item in items:
        one = placed[template_of(item, 0.0)]
        assert one.center_m == pytest.approx(item.center_m, abs=0.09)
        assert one.size_m == pytest.approx(item.size_m, abs=0.09)
        assert 90 * one.quarter_turns == pytest.approx(item.yaw_deg % 360, abs=1e-6)
    for instance in held.instances:
        labels = held.grid.labels[tuple(instance.cells.T)]
        assert (labels == instance.class_id).all()
        assert (held.grid.instance[tuple(instance.cells.T)] == instance.id).all()


@pytest.mark.parametrize(("category", "bottom_m"), [("sink", 0.7), ("stairs", 0.0)])
def test_an_object_without_a_template_is_built_from_its_cells(category, bottom_m):
    item = PlanObject(category, np.array([1.0, 1, bottom_m + 0.2]), np.array([0.4, 0.5, 0.4]), 0.0)
    assert template_of(item, 0.0) == OWN_CELLS


def test_a_finished_run_is_left_without_photos(place, tmp_path):
    built = build_plan(place, tmp_path / "OUT", Parameters(blocks_per_metre=2.0), name="flat")
    out = tmp_path / "OUT"
    assert (out / "build" / "world" / "level.dat").is_file()
    grid, scan_to_room = read_room(out / "room.npz")
    assert len(read_objects(out / "objects.json", grid)) == built.objects == 4
    assert len(read_placements(out / "placements.json")) >= 3
    (room,) = read_layouts(out / "layout.json")
    assert len(room.openings) == 3
    scan = json.loads((out / "scan.json").read_text())
    assert (scan["source"], scan["name"], scan["frames_used"]) == ("roomplan", "flat", [])
    assert scan_to_room @ built.scan.scan_to_room.T == pytest.approx(
        built.scan.scan_to_room @ built.scan.scan_to_room.T
    )
    again = tmp_path / "AGAIN"
    build_plan(place, again, Parameters(blocks_per_metre=2.0), name="flat")
    for name in ("room.npz", "placements.json", "layout.json", "build/room.schem"):
        assert (out / name).read_bytes() == (again / name).read_bytes()


def test_rooms_are_parted_by_walls_and_joined_by_doors(tmp_path):
    """Two rooms side by side, 12 cm apart, with one door that both of them hold."""
    first = layout(np.array([[0, 0], [3, 0], [3, 3], [0, 3]], float))
    second = layout(np.array([[3.12, 0], [6, 0], [6, 3], [3.12, 3]], float))
    door = replace(first.openings[0], kind="door", start_m=[3, 1], end_m=[3, 1.9])
    other = replace(door, start_m=[3.12, 1.9], end_m=[3.12, 1])
    rooms = [
        captured_room(replace(one, openings=(hole,), objects=()), SESSION)
        for one, hole in ((first, door), (second, other))
    ]
    path = tmp_path / "home.json"
    path.write_text(json.dumps({"identifier": "x", "rooms": rooms, "walls": []}))
    grid = rasterize_plan(straighten_plan(read_roomplan(path))).grid
    shoulder = grid.labels[:, :, round((1.5 - grid.origin_m[2]) / grid.voxel_m)]
    assert label_components(shoulder == 0, corners=False)[1] == 1
    high = grid.labels[:, :, round((2.2 - grid.origin_m[2]) / grid.voxel_m)]
    assert label_components(high == 0, corners=False)[1] == 2


def evidence_of(held, scan_to_room):
    """Evidence as if all of a plan's cells had been seen, each in its middle."""
    labels = held.grid.labels
    occupied, free = held.grid.occupied, labels == 0
    return FusedEvidence(
        log_odds=np.where(occupied, 2.0, np.where(free, -2.0, 0.0)).astype(np.float16),
        votes=np.zeros((*labels.shape, 12), np.float16),
        colour_sum=np.zeros((*labels.shape, 3), np.float32),
        offset_sum=np.zeros((*labels.shape, 3), np.float32),
        hits=occupied.astype(np.uint16),
        voxel_m=held.grid.voxel_m,
        origin_m=held.grid.origin_m,
        scan_to_room=scan_to_room,
    )


def test_a_plan_of_the_same_session_votes_for_what_is_there(place, plan, held):
    evidence = evidence_of(held, np.linalg.inv(plan.plan_to_session))
    laid = align_plan(read_roomplan(place), evidence)
    assert "shares the scan's frame" in laid.note
    assert laid.fit > 0.9
    voted = plan_votes(evidence, laid.plan)
    assert np.array_equal(voted.log_odds, evidence.log_odds)
    assert not voted.votes[~held.grid.occupied].any()
    any_vote = voted.votes.any(axis=3)
    said, true = voted.votes.argmax(axis=3)[any_vote], held.grid.labels[any_vote]
    things = (true >= SemanticClass.CHAIR).sum()
    assert things > 0.85 * (held.grid.labels[held.grid.occupied] >= SemanticClass.CHAIR).sum()
    assert np.mean(said == true) > 0.97


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_plan_of_another_frame_is_laid_on_the_walls(plan, held, turns):
    evidence = evidence_of(held, np.eye(4))
    move = rotation_about_z(90.0 * turns + 8.0)
    move[:3, 3] = [12.0, -7.0, 1.3]
    laid = align_plan(move_plan(plan, move), evidence)
    assert "aligned with the scanned walls" in laid.note
    true = plan.rooms[0].objects[0].center_m
    assert laid.plan.rooms[0].objects[0].center_m == pytest.approx(true, abs=0.13)


def test_a_plan_of_another_room_is_refused(tmp_path, held):
    other = replace(layout(np.array([[0, 0], [7, 0], [7, 2], [0, 2]], float)), openings=())
    path = tmp_path / "other.json"
    path.write_text(json.dumps(captured_room(other, SESSION)))
    with pytest.raises(PlanMismatchError, match="the plan does not match the scan"):
        align_plan(read_roomplan(path), evidence_of(held, np.eye(4)))


def test_a_square_room_fits_in_several_ways(tmp_path):
    polygon = np.array([[0, 0], [3, 0], [3, 3], [0, 3]], float)
    square = replace(layout(polygon), openings=(), objects=())
    path = tmp_path / "square.json"
    path.write_text(json.dumps(captured_room(square, SESSION)))
    plan = read_roomplan(path)
    evidence = evidence_of(rasterize_plan(straighten_plan(plan)), np.eye(4))
    with pytest.raises(PlanMismatchError, match="in several positions"):
        align_plan(plan, evidence)


def test_furniture_tells_which_way_a_plain_room_lies(tmp_path):
    """A square room fits in four ways; its sofa, table and chair in one."""
    polygon = np.array([[0, 0], [3.2, 0], [3.2, 3.2], [0, 3.2]], float)
    path = tmp_path / "furnished.json"
    path.write_text(json.dumps(captured_room(replace(layout(polygon), openings=()), SESSION)))
    plan = straighten_plan(read_roomplan(path))
    evidence = evidence_of(rasterize_plan(plan), np.eye(4))
    laid = align_plan(move_plan(plan, rotation_about_z(140.0)), evidence)
    assert "walls and furniture" in laid.note
    true = plan.rooms[0].objects[0].center_m
    assert laid.plan.rooms[0].objects[0].center_m == pytest.approx(true, abs=0.13)


def test_votes_stand_beside_those_of_images(plan, held):
    """A plan's vote of middle confidence, 0.6, counts half of what images said, and one."""
    evidence = evidence_of(held, np.eye(4))
    votes = evidence.votes.copy()
    tables = held.grid.labels == SemanticClass.TABLE
    votes[tables, SemanticClass.OBJS] = 40.0
    both = plan_votes(replace(evidence, votes=votes), plan).votes[tables]
    assert (both[:, SemanticClass.OBJS] >= 40).all()
    assert np.median(both[:, SemanticClass.TABLE]) == pytest.approx(0.6 * 21.0, rel=1e-3)


def test_openings_of_the_plan_join_those_that_were_found(plan):
    (planned,) = layouts_of(plan)
    found = replace(planned, openings=planned.openings[:1])
    shifted = replace(planned, openings=tuple(
        replace(one, start_m=one.start_m + 0.05, end_m=one.end_m + 0.05)
        for one in planned.openings
    ))  # fmt: skip
    (joined,) = merge_plan_openings([found], [shifted])
    assert len(joined.openings) == 3
    (same,) = merge_plan_openings([planned], [planned])
    assert len(same.openings) == 3
    far = replace(planned, floor_polygon_m=planned.floor_polygon_m + 20, openings=())
    assert merge_plan_openings([far], [planned])[0].openings == ()


def test_a_plan_alone_has_a_brief_report(place, tmp_path, capsys):
    assert find_lone_roomplan(place) == place
    assert find_lone_roomplan(place.parent) == place
    out = tmp_path / "OUT"
    run_plan(place, out, Parameters(blocks_per_metre=2.0), no_progress, "flat")
    print_run(load(out))
    assert "1 room of a floor plan, 4.0 x 3.2 x 2.4 m, 4 objects." in capsys.readouterr().out
    report = (out / "report.html").read_text()
    assert "flat: build report" in report
    assert report.count('sandbox="allow-scripts"') == 1
    assert (out / "preview.png").is_file()
    facts = json.loads((out / "report.json").read_text())
    assert facts["rooms"][0]["floor_m2"] == pytest.approx(11.0, abs=0.01)


def test_a_plan_refuses_what_needs_frames(place, tmp_path, capsys):
    words = ["reconstruct", str(place), "--out", str(tmp_path / "out")]
    assert cli.run([*words, "--labels", str(tmp_path), "--from", "build"]) == 2
    told = "Room.json is a RoomPlan without frames; omit --from and --labels"
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
