"""Things that touch other things, a wall or nothing: the geometric labeller tells them apart."""

import label_rooms as rooms
import numpy as np

from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller

CARDBOARD, LIT = (190, 150, 100), (70, 120, 165)


def labelled(room):
    grid, evidence, truth = room.scanned()
    return GeometricLabeller().label(grid, evidence), truth


def easy_chair(room, x, y):
    """Put an easy chair with its back towards y = 0, its back left corner at x, y."""
    room.add((x, y, 0, x + 0.84, y + 0.8, 0.46), 5, rooms.CLOTH)
    room.add((x, y, 0.46, x + 0.84, y + 0.22, 0.86), 5, rooms.CLOTH)
    for arm in (x, x + 0.66):
        room.add((arm, y, 0.46, arm + 0.18, y + 0.8, 0.62), 5, rooms.CLOTH)


def shelf(room, x, width, wall_y, front_y, wood=rooms.WOOD):
    """Put an open shelf against the wall at ``wall_y``: sides, boards and a thin back."""
    low, high = sorted((wall_y, front_y))
    for side in (x, x + width - 0.06):
        room.add((side, low, 0, side + 0.06, high, 1.9), 10, wood)
    for height in (0.0, 0.6, 1.2, 1.84):
        room.add((x, low, height, x + width, high, height + 0.06), 10, wood)
    back = sorted((wall_y, wall_y + np.sign(front_y - wall_y) * 0.04))
    room.add((x, back[0], 0, x + width, back[1], 1.9), 10, wood)


def test_an_easy_chair_beside_boxes_is_one_chair():
    room = rooms.SmallRoom()
    easy_chair(room, 1.0, 0.0)
    for x in (0.56, 1.84):
        room.add((x, 0.1, 0, x + 0.44, 0.8, 0.6), 10, CARDBOARD)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 5) > 0.9
    assert rooms.label_share(result, truth, 10) > 0.7


def test_back_of_an_open_shelf_is_shelf_a_picture_is_not():
    room = rooms.SmallRoom(size_m=(3.2, 4.0, 2.4))
    shelf(room, 0.4, 1.2, 0.0, 0.32)
    room.add((2.2, 0.0, 1.1, 2.8, 0.04, 1.6), 11, rooms.RED)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 10) > 0.9
    assert rooms.label_share(result, truth, 11) > 0.7


def test_a_lit_monitor_on_a_table_is_a_screen():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    room.add((1.56, 1.7, 0.78, 1.6, 2.3, 1.14), 9, LIT)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 9) > 0.8


def test_foot_of_a_chair_with_unseen_post_is_chair():
    room = rooms.SmallRoom()
    x, y = 1.6, 2.0
    room.add((x - 0.24, y - 0.24, 0.44, x + 0.24, y + 0.24, 0.48), 5, rooms.DARK)
    room.add((x - 0.24, y - 0.24, 0.48, x - 0.2, y + 0.24, 0.95), 5, rooms.DARK)
    for dx, dy in ((0.28, 0.05), (0.05, 0.28)):
        room.add((x - dx, y - dy, 0.04, x + dx, y + dy, 0.12), 5, rooms.DARK)
    box = (2.2, 3.0, 0.0, 2.6, 3.3, 0.2)
    room.add(box, 11, CARDBOARD)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 5) > 0.9
    assert rooms.label_share(result, truth, 11) > 0.9


def test_a_sofa_before_a_wall_is_no_screen():
    room = rooms.SmallRoom()
    room.add((1.0, 0.0, 0, 1.9, 0.8, 0.44), 5, (60, 95, 150))
    room.add((1.0, 0.0, 0.44, 1.9, 0.16, 0.86), 5, (60, 95, 150))
    result, _ = labelled(room)
    assert not (result.labels == 9).any()
