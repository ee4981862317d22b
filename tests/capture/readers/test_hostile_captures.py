"""Nonsense numbers in a capture of any format: it is read, or refused in one line.

The tables name every source and every solid format that the program reads, which a test checks.
"""

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from PIL import Image
from tests.capture.layouts import write_nerfstudio, write_plain, write_seven_scenes
from tests.capture.readers.apps import app_writers
from tests.capture.readers.datasets import test_datasets_scannetpp as scannetpp
from tests.capture.readers.datasets.test_datasets_colmap import write_colmap
from tests.capture.readers.datasets.test_datasets_nyu_raw import write_nyu
from tests.capture.readers.datasets.test_datasets_open3d import write_open3d
from tests.capture.readers.datasets.test_datasets_realsense import write_bag
from tests.capture.readers.datasets.test_datasets_replica import write_replica
from tests.capture.readers.datasets.test_datasets_scannet_folder import write_folder
from tests.capture.readers.datasets.test_datasets_sens import write_sens
from tests.capture.readers.datasets.test_datasets_sun import write_sun
from tests.capture.readers.datasets.test_datasets_tum import write_tum
from tests.capture.readers.meshes import mesh_writers
from tests.capture.readers.meshes.mesh_rooms import room_quads
from tests.exact_room import BoxRoom
from tests.hostile_files import PICKS, change_xml, limited_memory, replace_in

from world2minecraft.capture.format_detection import FALLBACK_SOURCES, SOURCES
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.meshes import mesh_source, usd_process
from world2minecraft.capture.readers.meshes.usd import read_stage
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view
from world2minecraft.core.errors import DamagedFileError, World2MinecraftError

Write = Callable[[Path], object]
room = BoxRoom()
views = room.views(4)
shots = app_writers.shots_of(room, 4)
quads = room_quads(boxes=())
points, colour, _ = quads.points(apart_m=0.25)
PHOTO_EXIF = {271: "Maker", 272: "Model", 274: 1, 37386: 4.2, 41989: 26, 33434: 0.01}


def write_phone(folder: Path) -> None:
    camera = scannetpp.DEPTH_CAMERA
    deep = [room.render(view.camera_to_scan, camera)[0] for view in views]
    pairs = zip(views, deep, strict=True)
    scannetpp.write_phone(
        folder, [replace(view, depth_m=depth_m, depth_camera=camera) for view, depth_m in pairs]
    )


def write_photos(folder: Path, count: int = 4) -> None:
    for index in range(count):
        exif = Image.Exif()
        exif.update(PHOTO_EXIF)
        exif.get_ifd(34665).update({37386: 4.2, 41989: 26, 40962: 160, 40963: 120})
        Image.fromarray(views[index].colour).save(folder / f"{index}.jpg", exif=exif)


def write_panoramas(folder: Path) -> None:
    ramp = np.abs(np.arange(256) - 128).astype(np.uint8)
    pixels = np.broadcast_to(ramp[None, :, None], (128, 256, 3))
    for n in range(4):
        Image.fromarray(np.roll(pixels, 7 * n, axis=1)).save(folder / f"{n}.png")


# Each source with what writes a small capture of it, and the files of it that hold numbers.
CAPTURES: dict[str, tuple[str, Write, tuple[str, ...]]] = {
    "plain": ("plain", lambda d: write_plain(d, views), ("capture.json",)),
    "record3d": (
        "record3d",
        lambda d: app_writers.write_record3d(d, shots),
        ("metadata", "rgbd/0.depth", "rgbd/0.conf"),
    ),
    "polycam": (
        "polycam",
        lambda d: app_writers.write_polycam(d, shots),
        ("keyframes/corrected_cameras/*.json", "mesh_info.json"),
    ),
    "stray": (
        "stray",
        lambda d: app_writers.write_stray(d, shots, video=False),
        ("odometry.csv", "camera_matrix.csv"),
    ),
    "stray_video": (
        "stray",
        lambda d: app_writers.write_stray(d, shots),
        ("rgb.mp4",),
    ),
    "arkitscenes": (
        "arkitscenes",
        lambda d: app_writers.write_arkitscenes(d, shots),
        ("lowres_wide.traj", "lowres_wide_intrinsics/*"),
    ),
    "scanner_app": (
        "scanner_app",
        lambda d: app_writers.write_scanner_app(d, shots),
        ("frame_*.json",),
    ),
    "scannet_sens": ("scannet_sens", lambda d: write_sens(d / "a.sens", views), ("a.sens",)),
    "scannet_folder": (
        "scannet_folder",
        lambda d: write_folder(d, views),
        ("pose/*.txt", "intrinsic/*.txt"),
    ),
    "scannetpp": ("scannetpp", write_phone, ("pose_intrinsic_imu.json", "depth.bin")),
    "tum": ("tum", lambda d: write_tum(d, views), ("*.txt",)),
    "replica": ("replica", lambda d: write_replica(d, views), ("traj.txt", "cam_params.json")),
    "sun": (
        "sun",
        lambda d: write_sun(d, views, [view.camera_to_scan for view in views]),
        ("intrinsics.txt", "extrinsics/*.txt"),
    ),
    "nyu_raw": ("nyu_raw", lambda d: write_nyu(d, views), ("*.pgm", "*.ppm", "*.dump")),
    "realsense": ("realsense", lambda d: write_bag(d / "a.bag", views), ("a.bag",)),
    "open3d": ("open3d", lambda d: write_open3d(d, views), ("trajectory.log", "camera.json")),
    "colmap_text": ("colmap", lambda d: write_colmap(d, views, text=True), ("sparse/0/*.txt",)),
    "colmap_binary": ("colmap", lambda d: write_colmap(d, views), ("sparse/0/*.bin",)),
    "nerfstudio": ("nerfstudio", lambda d: write_nerfstudio(d, views), ("transforms.json",)),
    "seven_scenes": (
        "seven_scenes",
        lambda d: write_seven_scenes(d, views),
        ("*.pose.txt", "camera-intrinsics.txt"),
    ),
    "solid": (
        "solid",
        lambda d: (d / "a.ply").write_bytes(mesh_writers.quad_ply(quads)),
        ("a.ply",),
    ),
    "video": (
        "video",
        lambda d: app_writers.write_video(d / "a.mp4", [shot.colour for shot in shots] * 3),
        ("a.mp4",),
    ),
    "panoramas": ("panoramas", write_panoramas, ("0.png",)),
    "photos": ("photos", write_photos, ("*.jpg",)),
    "photo": ("photo", lambda d: write_photos(d, 1), ("*.jpg",)),
}


def as_scene(path: Path) -> None:
    mesh = mesh_writers.as_trimesh(quads)
    path.write_bytes(trimesh.Scene([mesh]).export(file_type="glb"))


def write_gltf(folder: Path) -> None:
    files = trimesh.Scene([mesh_writers.as_trimesh(quads)]).export(file_type="gltf")
    for name, data in files.items():
        (folder / ("a.gltf" if name.endswith(".gltf") else name)).write_bytes(data)


def write_usda(path: Path) -> None:
    """A square of a room as text, whose numbers may be replaced by any."""
    path.write_text(
        '#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = "Y"\n)\n'
        'def Xform "Room"\n{\n    matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 1, 0, 0), '
        "(0, 0, 1, 0), (5, 6, 7, 1) )\n"
        '    uniform token[] xformOpOrder = ["xformOp:transform"]\n'
        '    def Mesh "Floor"\n    {\n'
        "        int[] faceVertexCounts = [4, 4]\n"
        "        int[] faceVertexIndices = [0, 1, 2, 3, 4, 5, 6, 7]\n"
        "        point3f[] points = [(0, 0, 0), (400, 0, 0), (400, 0, 300), (0, 0, 300), "
        "(0, 0, 0), (0, 250, 0), (400, 250, 0), (400, 0, 0)]\n"
        "        color3f[] primvars:displayColor = [(0.5, 0.5, 0.5)]\n    }\n}\n"
    )


def to_usdc(folder: Path) -> None:
    from pxr import Sdf

    write_usda(folder / "b.usda")
    Sdf.Layer.FindOrOpen(str(folder / "b.usda")).Export(str(folder / "a.usdc"))
    (folder / "b.usda").unlink()


def cloud(name: str, separator: str = " ", head: str = "") -> Write:
    return lambda d: mesh_writers.write_text(d / name, points, colour, separator, head)


def binary_cloud(d: Path) -> None:
    vertex = [*mesh_writers.places(points), *mesh_writers.paints(colour)]
    (d / "cloud.ply").write_bytes(mesh_writers.ply_bytes(">", vertex))


RECORDS = 'recordCount="50000000"'
IN_A_PROCESS = ("a.usdz", "a.usdc")  # Each read of them starts a process.

# Each file with what writes it; the suffixes are all that the reader of solids knows.
SOLIDS: dict[str, Write] = {
    "a.glb": lambda d: as_scene(d / "a.glb"),
    "a.gltf": write_gltf,
    "a.obj": lambda d: mesh_writers.write_obj(d, quads, "a"),
    "a.usdz": lambda d: mesh_writers.write_usdz(d / "a.usdz", quads),
    "a.usdc": to_usdc,
    "a.usda": lambda d: write_usda(d / "a.usda"),
    "a.usd": lambda d: write_usda(d / "a.usd"),
    "a.ply": lambda d: (d / "a.ply").write_bytes(mesh_writers.quad_ply(quads)),
    "cloud.ply": binary_cloud,
    "a.stl": lambda d: mesh_writers.write_stl(d / "a.stl", quads),
    "a.off": lambda d: (d / "a.off").write_text(
        mesh_writers.as_trimesh(quads).export(file_type="off")
    ),
    "a.e57": lambda d: mesh_writers.write_e57(d / "a.e57", points, colour),
    "a.laz": lambda d: mesh_writers.write_las(d / "a.laz", points, colour),
    "a.las": lambda d: mesh_writers.write_las(d / "a.las", points, colour),
    "a.pts": cloud("a.pts", head=f"{len(points)}\n"),
    "a.xyz": cloud("a.xyz"),
    "a.xyzrgb": cloud("a.xyzrgb"),
    "a.asc": cloud("a.asc"),
    "a.txt": cloud("a.txt"),
    "a.csv": cloud("a.csv", ",", "X,Y,Z,R,G,B\n"),
}


def read_capture(path: Path) -> str:
    checked = validate_capture(path, ScanOptions())
    for frame in checked.frames[:2]:
        if checked.complete:
            read_view(frame, checked.encoding, checked.capture.full_trust)
    return checked.capture.source


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Return a function that gives the folder of a capture, written once."""
    root = tmp_path_factory.mktemp("written")

    def folder_of(name: str, write: Write) -> Path:
        folder = root / name
        if not folder.exists():
            folder.mkdir()
            write(folder)
        return folder

    return folder_of


def refused_in_one_line(read: Callable[[], object]) -> None:
    try:
        with limited_memory():
            read()
    except World2MinecraftError as error:
        assert error.exit_code == 3
        assert "\n" not in str(error)
        assert len(str(error)) < 1500


def test_every_source_and_solid_format_is_tried():
    assert {source for source, _, _ in CAPTURES.values()} == set(SOURCES.names())
    assert {Path(name).suffix for name in SOLIDS} == set(mesh_source.READERS)


@pytest.mark.parametrize("name", CAPTURES)
def test_the_captures_are_read_unchanged(name, written):
    source, write, patterns = CAPTURES[name]
    folder = written(name, write)
    assert all(list(folder.glob(pattern)) for pattern in patterns)
    if source not in FALLBACK_SOURCES:
        assert read_capture(folder).split(" ")[0] == source


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", CAPTURES)
@settings(max_examples=30, suppress_health_check=list(HealthCheck))
@given(picks=PICKS)
def test_extreme_numbers_in_a_capture(name, written, tmp_path_factory, picks):
    _, write, patterns = CAPTURES[name]
    folder = tmp_path_factory.mktemp(name) / "room"
    shutil.copytree(written(name, write), folder)
    files = [file for pattern in patterns for file in sorted(folder.glob(pattern))]
    replace_in(files[int(picks[-1][0] * 9973) % len(files)], picks)
    refused_in_one_line(lambda: read_capture(folder))
    shutil.rmtree(folder)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", [name for name in SOLIDS if name not in IN_A_PROCESS])
@settings(max_examples=30, suppress_health_check=list(HealthCheck))
@given(picks=PICKS)
def test_extreme_numbers_in_a_solid(name, written, tmp_path_factory, picks):
    try_solid(name, written, tmp_path_factory, picks)


@pytest.mark.parametrize("name", IN_A_PROCESS)
@settings(max_examples=2, suppress_health_check=list(HealthCheck))
@given(picks=PICKS)
def test_extreme_numbers_in_a_binary_usd(name, written, tmp_path_factory, picks):
    try_solid(name, written, tmp_path_factory, picks)


def try_solid(name, written, tmp_path_factory, picks):
    folder = tmp_path_factory.mktemp("solid") / "room"
    shutil.copytree(written(f"solid-{name}", SOLIDS[name]), folder)
    replace_in(folder / name, picks)
    refused_in_one_line(lambda: read_solid(folder / name))
    shutil.rmtree(folder)


def read_solid(path: Path) -> None:
    """Read a solid; a text of USD without a process of its own, which takes seconds."""
    is_text = path.suffix in (".usda", ".usd")
    loaded = read_stage(path) if is_text else mesh_source.load_geometry(path)
    assert np.isfinite(loaded.geometry.positions).all() and np.isfinite(loaded.offset).all()


def test_a_crash_of_the_usd_library_is_one_line(written, monkeypatch):
    monkeypatch.setattr(usd_process, "CALL", "import os; os.abort()")
    path = written("solid-a.usda", SOLIDS["a.usda"]) / "a.usda"
    with pytest.raises(DamagedFileError, match=r"a.usda: cannot be read as USD .*crashed"):
        mesh_source.load_geometry(path)


@pytest.mark.parametrize(
    ("name", "at", "number", "words"),
    [
        ("a.las", 100, 0x7FFFFFFF, "declares 2,147,483,647 records"),
        ("a.laz", 96, 0x7FFFFFFF, "more than the file contains"),
    ],
)
def test_records_of_las_are_counted_first(name, at, number, words, written, tmp_path):
    data = bytearray((written(f"solid-{name}", SOLIDS[name]) / name).read_bytes())
    data[at : at + 4] = number.to_bytes(4, "little")
    (tmp_path / name).write_bytes(data)
    with pytest.raises(DamagedFileError, match=words):
        mesh_source.load_geometry(tmp_path / name)


def test_points_of_e57_are_counted_before_they_are_read(written, tmp_path):
    source = written("solid-a.e57", SOLIDS["a.e57"]) / "a.e57"
    shutil.copy(source, tmp_path / "a.e57")
    change_xml(tmp_path / "a.e57", lambda xml: re.sub('recordCount="\\d+"', RECORDS, xml, count=1))
    with pytest.raises(DamagedFileError, match="is too short for 50,000,"):
        mesh_source.load_geometry(tmp_path / "a.e57")


@pytest.mark.parametrize("name", SOLIDS)
def test_the_solids_are_read_unchanged(name, written):
    folder = written(f"solid-{name}", SOLIDS[name])
    assert len(mesh_source.load_geometry(folder / name).geometry.positions)
