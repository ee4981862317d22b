"""The inside: against slow rays; rooms with holes are found, objects and shells are not."""

import numpy as np
import pytest
from mesh_rooms import SIZE_M, box_quads, room_quads
from scipy import ndimage

from world2minecraft.capture.readers.meshes.interior import (
    enclosure_votes,
    find_interior,
    voxelise_surface,
)
from world2minecraft.capture.readers.meshes.mesh_and_cloud import Mesh, PointCloud
from world2minecraft.capture.readers.meshes.viewpoints import CAMERA, choose_views


def mesh_of(quads):
    vertices, faces, colour, _ = quads.triangles()
    return Mesh(vertices.astype(np.float32), faces.astype(np.int32), colour)


def interior_of(solid, inside=None):
    low, high = solid.positions.min(axis=0), solid.positions.max(axis=0)
    grid = voxelise_surface(solid, low.astype(float) - 0.3, high.astype(float) + 0.3)
    return grid, find_interior(grid, inside)


def walked(held, cell, way):
    """Whether a walk from a cell meets a held one, step by step."""
    cell = np.array(cell)
    axes = np.flatnonzero(way)
    while True:
        before, cell = cell, cell + way
        if (cell < 0).any() or (cell >= held.shape).any():
            return False
        if held[tuple(cell)]:
            return True
        if len(axes) == 2:
            sides = [before + np.eye(3, dtype=int)[axis] * way[axis] for axis in axes]
            if all(held[tuple(side)] for side in sides):
                return True


def test_enclosure_votes_match_walks_cell_by_cell():
    held = np.random.default_rng(2).random((7, 6, 5)) < 0.12
    down, side, up, drop = enclosure_votes(held)
    ways = [np.array(w) - 1 for w in np.ndindex(3, 3, 3) if w != (1, 1, 1)]
    for cell in np.ndindex(*held.shape):
        met = [(way[2], walked(held, cell, way)) for way in ways]
        assert down[cell] == sum(hit for z, hit in met if z < 0)
        assert side[cell] == sum(hit for z, hit in met if z == 0)
        assert up[cell] == sum(hit for z, hit in met if z > 0)
        below = np.flatnonzero(held[cell[0], cell[1], : cell[2]])
        assert drop[cell] == (cell[2] - below[-1] if len(below) else 0)


def test_triangles_mark_the_cells_that_they_pass():
    mesh = Mesh(np.float32([[0, 0, 0], [3, 0.4, 1], [0.2, 2, 2]]), np.int32([[0, 1, 2]]))
    grid = voxelise_surface(mesh, np.zeros(3), np.full(3, 3.0))
    s, t = np.meshgrid(np.linspace(0, 1, 400), np.linspace(0, 1, 400))
    inner = (s + t <= 1).ravel()
    s, t = s.ravel()[inner, None], t.ravel()[inner, None]
    a, b, c = mesh.vertices.astype(float)
    cells = np.floor((a + s * (b - a) + t * (c - a) - grid.origin_m) / grid.cell_m).astype(int)
    expected = np.zeros_like(grid.occupied)
    expected[tuple(cells.T)] = True
    assert (grid.occupied & expected).sum() > 0.85 * expected.sum()  # Corners of cells are missed,
    assert not (
        expected & ~ndimage.binary_dilation(grid.occupied)
    ).any()  # never a whole cell and its neighbours.


@pytest.mark.parametrize("without", [(), (5,), (1,), (1, 5)], ids=str)
def test_interior_is_found_without_ceiling_or_one_wall(without):
    grid, interior = interior_of(mesh_of(room_quads(without=without)))
    assert interior is not None and interior.spaces == 1 and not interior.is_open
    cells = grid.centers_m(np.argwhere(interior.clear))
    assert ((cells > 0) & (cells < SIZE_M)).all()
    poses = choose_views(grid, interior)
    assert 40 <= len(poses) <= 120
    assert ((poses[:, :3, 3] > 0.15) & (poses[:, :3, 3] < np.array(SIZE_M) - 0.15)).all()


@pytest.mark.parametrize("height_m", [0.8, 1.2, 1.45])
def test_low_walls_without_ceiling_enclose_a_room(height_m):
    low = room_quads((4.2, 3.1, height_m), boxes=(), without=(5,))
    grid, interior = interior_of(mesh_of(low))
    assert interior is not None and interior.spaces == 1
    poses = choose_views(grid, interior)
    places = poses[:, :3, 3]
    assert ((places[:, :2] > 0.15) & (places[:, :2] < np.array([4.2, 3.1]) - 0.15)).all()
    assert 0.5 < places[:, 2].max() < 1.7


@pytest.mark.parametrize("height_m", [1.3, 2.5])
def test_two_walls_at_a_corner_show_a_room_and_one_does_not(height_m):
    two_walls = room_quads((4.2, 3.1, height_m), boxes=(), without=(1, 3, 5))
    grid, interior = interior_of(mesh_of(two_walls))
    assert interior is not None and interior.is_open
    cells = grid.centers_m(np.argwhere(interior.clear))
    assert ((cells[:, :2] > 0) & (cells[:, :2] < SIZE_M[:2])).all()
    one_wall = room_quads((4.2, 3.1, height_m), boxes=(), without=(1, 2, 3, 5))
    assert interior_of(mesh_of(one_wall))[1] is None


def test_a_cloud_has_the_interior_of_its_mesh(quads):
    points, _, _ = quads.points(apart_m=0.05)
    _, interior = interior_of(PointCloud(points.astype(np.float32)))
    assert interior is not None and interior.spaces == 1


def test_the_inside_of_a_cupboard_is_no_room(quads):
    grid, interior = interior_of(mesh_of(quads))
    cupboard = np.floor(([3.95, 0.5, 1.0] - grid.origin_m) / grid.cell_m).astype(int)
    assert interior is not None and not interior.clear[tuple(cupboard)]


def two_rooms():
    """Two rooms side by side, the wall between them closed."""
    walls = [box_quads((x, 0, 0), (x + 4.0, 3.0, 2.5), inward=True) for x in (0.0, 4.2)]
    quads = room_quads()
    corners = np.concatenate(walls)
    shape = (len(corners), 3)
    return type(quads)(corners, np.zeros(shape, np.uint8), np.zeros(len(corners), np.uint8))


def test_all_rooms_of_a_flat_or_the_named_one_are_found():
    mesh = mesh_of(two_rooms())
    grid, both = interior_of(mesh)
    assert both is not None and both.spaces == 2
    places = choose_views(grid, both)[:, 0, 3]
    assert (places < 4).any() and (places > 4.2).any()
    grid, one = interior_of(mesh, np.array([6.0, 1.5, 1.2]))
    assert one is not None and one.spaces == 1
    assert (choose_views(grid, one)[:, 0, 3] > 4.2).all()


def test_objects_and_landscapes_have_no_inside():
    chair = box_quads((0, 0, 0), (0.5, 0.5, 0.5))
    floor = box_quads((-3, -3, -0.1), (3, 3, 0))
    shape = type(room_quads())
    for corners in (chair, np.concatenate([chair, floor])):
        none = np.zeros((len(corners), 3), np.uint8)
        assert interior_of(mesh_of(shape(corners, none, none[:, 0])))[1] is None


def test_views_see_all_walls_more_than_once(quads):
    grid, interior = interior_of(mesh_of(quads))
    poses = choose_views(grid, interior)
    assert (choose_views(grid, interior) == poses).all()
    ahead, down = poses[:, :3, 2], poses[:, :3, 1]
    assert (down[:, 2] < 0).all()  # Upright.
    for way in np.concatenate([np.eye(3), -np.eye(3)])[[0, 1, 3, 4]]:
        assert (ahead @ way > 0.5).sum() >= 3
    assert CAMERA.width_px == 2 * CAMERA.fx_px
