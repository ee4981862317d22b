"""Joining rooms: laws of moving, doors that meet, what is refused, and the files that are left."""

import json
from dataclasses import replace

import numpy as np
import pytest
from homes import BED, KITCHEN, bedroom, hall, kitchen, room, run_of, table

from world2minecraft.cli import run as w2m
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.formats.layout import read_layouts, write_layouts
from world2minecraft.formats.objects_and_placements import (
    read_objects,
    write_objects,
    write_placements,
)
from world2minecraft.formats.run_arrays import read_room, write_room
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.homes import (
    Move,
    merge_runs,
    move_run,
    parse_place,
    place_runs,
    read_runs,
)
from world2minecraft.reconstruction.homes.room_placement import fits

ANYWHERE = Move(3, (17, -40, 2))


def same(one, other):
    for name in ("labels", "confidence", "colour", "source", "instance"):
        assert np.array_equal(getattr(one.grid, name), getattr(other.grid, name))
    assert one.grid.origin_m == pytest.approx(other.grid.origin_m, abs=1e-9)
    for mine, theirs in zip(one.instances, other.instances, strict=True):
        assert mine.center_m == pytest.approx(theirs.center_m, abs=1e-3)
        assert mine.yaw_deg % 360 == theirs.yaw_deg % 360
        assert sorted(mine.cells.tolist()) == sorted(theirs.cells.tolist())
    for mine, theirs in zip(one.placements, other.placements, strict=True):
        assert mine.quarter_turns == theirs.quarter_turns
        assert mine.center_m == pytest.approx(theirs.center_m, abs=1e-3)
    for mine, theirs in zip(one.layouts, other.layouts, strict=True):
        assert mine.floor_polygon_m == pytest.approx(theirs.floor_polygon_m, abs=1e-3)


def test_four_quarter_turns_are_the_identity():
    run = kitchen()
    turned = run
    for _ in range(4):
        turned = move_run(turned, Move(1))
    same(turned, run)


def test_there_and_back_is_the_identity():
    run = kitchen()
    back = Move(1, (-40, -17, -2))
    assert back.after(ANYWHERE) == Move(0, (0, 0, 0))
    same(move_run(move_run(run, ANYWHERE), back), run)


@pytest.mark.parametrize("first", [Move(1, (3, 4, 0)), Move(2, (-5, 0, 1)), Move(3)])
def test_two_moves_are_one(first):
    run = kitchen()
    same(move_run(move_run(run, first), ANYWHERE), move_run(run, ANYWHERE.after(first)))


def test_cells_move_with_the_frame():
    """What lies at a place is found at the moved place."""
    run, new = kitchen(), move_run(kitchen(), ANYWHERE)
    to_new = ANYWHERE.transform(run.grid.voxel_m)
    cells = np.argwhere(run.grid.labels == 8)
    middles = run.grid.origin_m + (cells + 0.5) * run.grid.voxel_m
    there = middles @ to_new[:3, :3].T + to_new[:3, 3]
    found = np.floor((there - new.grid.origin_m) / new.grid.voxel_m).astype(int)
    assert (new.grid.labels[tuple(found.T)] == 8).all()


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_rooms_find_their_doors_from_any_frame(turns):
    own = [
        kitchen(),
        move_run(hall(), Move(turns, (5, 9, 0))),
        move_run(bedroom(), Move(3 - turns)),
    ]
    placed = place_runs(own)
    for run, true in zip(placed.runs, (kitchen(), hall(), bedroom()), strict=True):
        assert run.layouts[0].floor_polygon_m.min(axis=0) == pytest.approx(
            true.layouts[0].floor_polygon_m.min(axis=0), abs=0.09
        )
    assert "hall was placed next to kitchen at a door 0.80 m wide" in placed.lines
    assert "bed was placed next to kitchen at a door 1.00 m wide" in placed.lines


def test_each_room_stays_as_it_was_and_doors_are_open():
    placed = place_runs([kitchen(), hall(), bedroom()])
    home = merge_runs(placed, "home")
    grid = home.run.grid
    for number, run in enumerate(placed.runs):
        mine, theirs = (
            inside(each.grid, each.layouts[which].floor_polygon_m)
            for each, which in ((home.run, number), (run, 0))
        )
        assert np.array_equal(mine, theirs)
    shoulder = grid.labels[:, :, round((1.4 - grid.origin_m[2]) / grid.voxel_m)]
    assert label_components(shoulder == 0, corners=False)[1] == 1
    assert len(home.run.layouts) == 3
    assert home.size_m == pytest.approx([5.2, 6.0, 2.5], abs=0.17)
    assert "2 doors between the rooms left open" in home.lines


def inside(grid, polygon):
    """The labels of the cells within a room's box, from its floor to 2.4 m."""
    first, last = (
        np.rint((at - grid.origin_m[:2]) / grid.voxel_m + sign).astype(int)
        for at, sign in ((polygon.min(axis=0), 1), (polygon.max(axis=0), -1))
    )
    height = round(-grid.origin_m[2] / grid.voxel_m)
    return grid.labels[first[0] : last[0], first[1] : last[1], height : height + 30]


def test_objects_keep_their_cells_and_get_numbers_of_their_own():
    home = merge_runs(place_runs([kitchen(), bedroom()]))
    numbers = [one.id for one in home.run.instances]
    assert len(set(numbers)) == len(numbers)
    tables = [one for one in home.run.instances if one.class_id == 8]
    assert len(tables) == 2
    for one in home.run.instances:
        assert (home.run.grid.instance[tuple(one.cells.T)] == one.id).all()
        assert (home.run.grid.labels[tuple(one.cells.T)] == one.class_id).all()
    held = {one.object_id for one in home.run.placements}
    assert held <= set(numbers)


def test_what_was_seen_through_a_door_is_the_next_rooms():
    """The kitchen's scan saw the bedroom's table too; it stands there once."""
    both = room(KITCHEN, [((1.2, 2.8), (2.2, 2.8), 2.2)], [table(1.2, 1.2)])
    seen = run_of("kitchen", both, room(BED, (), [table(2.6, 4.8)]))
    seen = replace(seen, layouts=seen.layouts[:1])
    home = merge_runs(place_runs([seen, bedroom()], {"bed": Move()}))
    assert len([one for one in home.run.instances if one.class_id == 8]) == 2
    assert any("seen through doors" in text for text in home.lines)


def test_a_room_that_fits_in_two_places_is_not_guessed():
    """Two equal doors: what to type is told, and typing it works."""
    doors = [((3.6, 1.0), (3.6, 1.8), 2.0), ((0.0, 1.0), (0.0, 1.8), 2.0)]
    runs = [run_of("kitchen", room(KITCHEN, doors)), hall()]
    with pytest.raises(UsageError, match="hall fits about equally well in 2 positions") as caught:
        place_runs(runs)
    words = str(caught.value).split("--at ")[1:]
    assert len(words) == 2
    places = set()
    for word in words:
        name, move = parse_place(word.split(" ")[0], ["kitchen", "hall"], 0.08)
        placed = place_runs(runs, {name: move})
        places.add(tuple(placed.runs[1].grid.origin_m.tolist()))
    assert len(places) == 2


def test_what_was_seen_through_the_door_decides():
    """Of two equal doors the kitchen looked through one, and saw the hall's far wall."""
    doors = [((3.6, 1.0), (3.6, 1.8), 2.0), ((0.0, 1.0), (0.0, 1.8), 2.0)]
    hall_room = room((3.76, 0.0, 5.2, 4.0), [((3.76, 1.0), (3.76, 1.8), 2.0)])
    seen = run_of("kitchen", room(KITCHEN, doors), hall_room)
    seen = replace(seen, layouts=seen.layouts[:1])
    options = fits(hall(), [seen])
    assert options[0].score > options[1].score + 0.15
    placed = place_runs([seen, hall()])
    assert placed.moves[1] == Move()


def test_a_room_without_a_door_needs_a_place():
    closed = run_of("store", room((0.0, 0.0, 2.0, 2.0)))
    with pytest.raises(
        UsageError, match="it has no detected door.*; set its position .--at store="
    ):
        place_runs([kitchen(), closed])
    placed = place_runs([kitchen(), closed], {"store": Move(1, (100, 0, 0))})
    assert "store was placed at the given position (--at)" in placed.lines


def test_rooms_in_one_place_are_refused():
    with pytest.raises(UsageError, match="overlap by .* m2 of floor"):
        place_runs([kitchen(), bedroom()], {"bed": Move(1, (75, 0, 0))})


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("kitchen", "must be NAME=X,Y,TURNS"),
        ("kitchen=1,2", "must be NAME=X,Y,TURNS"),
        ("kitchen=1,2,0.5", "must be NAME=X,Y,TURNS"),
        ("kitchen=nan,2,1", "must be NAME=X,Y,TURNS"),
        ("bath=1,2,3", "known rooms: kitchen, hall"),
    ],
)
def test_bad_places_are_refused(text, reason):
    with pytest.raises(UsageError, match=reason):
        parse_place(text, ["kitchen", "hall"], 0.08)


def test_places_are_whole_cells_and_quarter_turns():
    assert parse_place("kitchen=0.8,-1.6,5", ["kitchen"], 0.08) == (
        "kitchen",
        Move(1, (10, -20, 0)),
    )
    assert parse_place("kitchen=0,0,-1,2.56", ["kitchen"], 0.08)[1] == Move(3, (0, 0, 32))


def write_run(folder, run):
    folder.mkdir()
    write_room(folder / "room.npz", run.grid, np.eye(4))
    write_objects(folder / "objects.json", run.instances)
    write_placements(folder / "placements.json", run.placements)
    write_layouts(folder / "layout.json", run.layouts)
    return folder


def test_the_verb_leaves_a_run_with_a_world_and_a_report(tmp_path, capsys):
    first = write_run(tmp_path / "kitchen", kitchen())
    second = write_run(tmp_path / "bed", move_run(bedroom(), Move(1, (4, 4, 0))))
    (second / "report.html").write_text("<p>its own</p>")
    out = tmp_path / "HOME"
    words = ["join", str(first), str(second), "--out", str(out), "--blocks-per-metre", "2"]
    assert w2m(words) == 0
    assert "bed was placed next to kitchen" in capsys.readouterr().out
    assert (out / "build" / "world" / "level.dat").is_file()
    assert (out / "preview.png").is_file()
    grid, _ = read_room(out / "room.npz")
    assert len(read_layouts(out / "layout.json")) == 2
    assert len(read_objects(out / "objects.json", grid)) >= 2
    page = (out / "report.html").read_text()
    assert "../bed/report.html" in page
    assert "../kitchen/report.html" not in page
    scan = json.loads((out / "scan.json").read_text())
    assert scan["source"] == "joined"
    again = tmp_path / "AGAIN"
    assert w2m(["build", str(out), "--out", str(again), "--blocks-per-metre", "2"]) == 0


@pytest.mark.parametrize("how", ["missing", "damaged", "one", "itself", "cells"])
def test_the_verb_refuses_in_one_line(tmp_path, capsys, how):
    first = write_run(tmp_path / "kitchen", kitchen())
    second = write_run(tmp_path / "bed", bedroom())
    words = ["join", str(first), str(second), "--out", str(tmp_path / "HOME")]
    expected = 3
    if how == "missing":
        (second / "placements.json").unlink()
    elif how == "damaged":
        (second / "layout.json").write_text('[{"name": 1}]')
    elif how == "one":
        words, expected = ["join", str(first), "--out", str(tmp_path / "HOME")], 2
    elif how == "itself":
        words[-1], expected = str(second), 2
    elif how == "cells":
        run = bedroom()
        coarse = replace(run.grid, voxel_m=0.16, origin_m=run.grid.origin_m * 2)
        write_room(second / "room.npz", coarse, np.eye(4))
        expected = 2
    assert w2m(words) == expected
    error = capsys.readouterr().err.strip()
    assert error.splitlines()[-1].startswith("error: ")
    assert not (tmp_path / "HOME").exists()


def test_runs_of_one_name_are_told_apart(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    folders = [
        write_run(tmp_path / "a" / "OUT", kitchen()),
        write_run(tmp_path / "b" / "OUT", hall()),
    ]
    assert [run.name for run in read_runs(folders)] == ["OUT", "OUT-2"]
    with pytest.raises(InputError, match="is not a finished run"):
        read_runs([tmp_path / "a", tmp_path / "b"])
