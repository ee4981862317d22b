"""PLY, byte by byte: orders, kinds, polygons, what lies between, and clouds of millions."""

import mesh_writers as writers
import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture.readers.meshes.colours_and_classes import to_uint8_colours
from world2minecraft.capture.readers.meshes.ply import load_ply, read_ply, triangulate_fans
from world2minecraft.capture.readers.meshes.voxel_downsampling import MAX_POINTS, VoxelDownsampler
from world2minecraft.core.errors import DamagedFileError, LimitError

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 2]], float)
FACES = [[0, 1, 2, 3], [0, 1, 4], [1, 2, 4]]


@pytest.mark.parametrize("order", ["a", "<", ">"])
def test_polygons_of_any_length_are_cut_into_triangles(tmp_path, order):
    path = tmp_path / "a.ply"
    columns = [("class", "i4", [5, 6, 7])]
    vertex = [*writers.places(CORNERS), ("label", "u2", [1, 2, 3, 4, 500])]
    path.write_bytes(writers.ply_bytes(order, vertex, FACES, columns, ["made by hand"]))
    file = read_ply(path)
    assert file.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 4], [1, 2, 4]]
    assert file.triangle_face.tolist() == [0, 0, 1, 2]
    assert file.face["class"].tolist() == [5, 6, 7]
    assert file.vertex["label"].tolist() == [1, 2, 3, 4, 500]
    assert file.comments == ("made by hand",)
    np.testing.assert_array_equal(file.vertex["z"], CORNERS[:, 2])


def test_a_texture_that_pillow_refuses_is_named_as_too_large(tmp_path, monkeypatch):
    Image.new("RGB", (64, 64)).save(tmp_path / "paint.png")
    path = tmp_path / "a.ply"
    vertex = [*writers.places(CORNERS), ("s", "f4", CORNERS[:, 0]), ("t", "f4", CORNERS[:, 1])]
    path.write_bytes(writers.ply_bytes("<", vertex, FACES, comments=["TextureFile paint.png"]))
    assert load_ply(path).geometry.coloured
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 1000)
    with pytest.raises(LimitError, match="a texture image of more than 64 megapixels"):
        load_ply(path)


def test_fans_of_equal_and_of_mixed_polygons_agree():
    counts, values = np.array([3, 3]), np.array([4, 5, 6, 7, 8, 9])
    assert triangulate_fans(counts, values)[0].tolist() == [[4, 5, 6], [7, 8, 9]]
    mixed = triangulate_fans(np.array([3, 2, 3]), np.array([4, 5, 6, 0, 1, 7, 8, 9]))
    assert mixed[0].tolist() == [[4, 5, 6], [7, 8, 9]] and mixed[1].tolist() == [0, 2]


def test_colours_of_faces_and_shares_are_read(tmp_path):
    path = tmp_path / "a.ply"
    columns = [(n, "u1", [10 * k, 20, 30]) for k, n in enumerate(("red", "green", "blue"), 1)]
    path.write_bytes(
        writers.ply_bytes(
            "<",
            writers.places(CORNERS),
            FACES[1:],
            [(name, kind, values[1:]) for name, kind, values in columns],
        )
    )
    mesh = load_ply(path).geometry
    assert mesh.colour.tolist() == [[20, 20, 20]] * 3 + [[30, 30, 30]] * 3
    assert to_uint8_colours(np.array([[0.0, 0.5, 1.0]])).tolist() == [[0, 128, 255]]
    assert to_uint8_colours(np.array([[0, 32896, 65535]], np.uint16)).tolist() == [[0, 128, 255]]
    assert to_uint8_colours(np.zeros((1, 3), np.uint16)) is None


def test_gaussian_splats_are_the_cloud_of_their_firm_middles(tmp_path):
    vertex = writers.places(CORNERS)
    vertex += [(f"f_dc_{c}", "f4", np.full(5, value)) for c, value in enumerate((-1, 0, 1.0))]
    vertex += [("opacity", "f4", np.array([2, 2, -3, 2, 2.0]))]
    (tmp_path / "a.ply").write_bytes(writers.ply_bytes("<", vertex))
    cloud = load_ply(tmp_path / "a.ply").geometry
    assert len(cloud.points) == 4 and cloud.colour[0].tolist() == [56, 128, 199]


def test_places_far_from_the_origin_keep_their_millimetres(tmp_path):
    far = CORNERS + np.array([3_500_000.123, 5_400_000.456, 0])
    vertex = [(axis, "f8", far[:, a]) for a, axis in enumerate("xyz")]
    (tmp_path / "a.ply").write_bytes(writers.ply_bytes("<", vertex))
    loaded = load_ply(tmp_path / "a.ply")
    np.testing.assert_allclose(loaded.geometry.points + loaded.offset, far, atol=1e-4)


def test_many_points_are_downsampled_to_voxel_means():
    rng = np.random.default_rng(0)
    thinner = VoxelDownsampler()
    for _ in range(5):
        points = np.column_stack([rng.uniform(0, 1, (1_000_000, 2)), np.full(1_000_000, 0.5)])
        thinner.add(points, np.full(points.shape, 7, np.uint8))
    cloud = thinner.cloud()
    assert thinner.read == 5_000_000 > MAX_POINTS
    assert len(cloud.points) < 10_000 and (cloud.colour == 7).all()
    spread = np.histogram2d(*cloud.points[:, :2].T, bins=10)[0]
    assert spread.min() > 0.7 * spread.max()


@pytest.mark.parametrize(
    ("unit_m", "longest", "cell"),
    [(1.0, 90.0, 0.015), (None, 90.0, 0.015), (None, 600.0, 1.5), (None, 9000.0, 15.0)],
)
def test_voxel_size_of_downsampled_clouds(unit_m, longest, cell):
    thinner = VoxelDownsampler(unit_m)
    points = np.random.default_rng(0).uniform(0, 1, (600_000, 3)) * [1.02 * longest, 1, 1]
    thinner.add(points)
    thinner.cloud()
    assert thinner.cell == pytest.approx(cell)


def test_two_properties_of_one_name_get_unique_names(tmp_path):
    names = (*"xyz", "scalar", "second")
    vertex = [(name, "f4", CORNERS[:, n % 3]) for n, name in enumerate(names)]
    data = writers.ply_bytes("<", vertex).replace(b"second", b"scalar")
    (tmp_path / "a.ply").write_bytes(data)
    assert {"scalar", "scalar.2"} < set(read_ply(tmp_path / "a.ply").vertex)


@pytest.mark.parametrize("order", ["<", "a"])
def test_a_table_that_promises_more_than_the_file_holds(tmp_path, order):
    vertex = [(axis, "f4", CORNERS[:, a]) for a, axis in enumerate("xyz")]
    data = writers.ply_bytes(order, vertex)
    more = b"element other 99999999999\nproperty list uchar int parts\nelement vertex"
    (tmp_path / "a.ply").write_bytes(data.replace(b"element vertex", more, 1))
    with pytest.raises(DamagedFileError, match="expected 99,999,999,999 other rows"):
        read_ply(tmp_path / "a.ply")


def test_a_table_without_properties_is_passed_over(tmp_path):
    vertex = [(axis, "f4", CORNERS[:, a]) for a, axis in enumerate("xyz")]
    data = writers.ply_bytes("<", vertex)
    more = data.replace(b"element vertex", b"element other 5\nelement vertex", 1)
    (tmp_path / "a.ply").write_bytes(more)
    assert len(read_ply(tmp_path / "a.ply").vertex["x"]) == len(CORNERS)
