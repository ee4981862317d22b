"""What the exporters wrote, and what others might have, read as samples."""

import pickle
import shutil

import numpy as np
import pytest
from tests.minecraftocc.exchange import synthetic

from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError
from world2minecraft.minecraftocc.exporters import ExportRule, export_samples
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.minecraftocc.importers.embodied import read_scene

KEY = "house_0001-t0-00000"


@pytest.fixture(scope="module")
def made():
    return synthetic.sample(eye_m=(4.4, 3.0, 1.5), target_m=(0.5, 3.4, 0.9), quarters=1)


@pytest.fixture(scope="module")
def folders(made, tmp_path_factory):
    root = tmp_path_factory.mktemp("formats")
    plain = synthetic.sample(eye_m=(4.4, 3.0, 1.5), target_m=(0.5, 3.4, 0.9), quarters=1)
    plain.facts.pop("first_seen")  # An array is no fact that a file could hold.
    for name in ("nyu", "embodied", "npz"):
        export_samples([plain], name, root / name)
    return root


def back(folders, name):
    found = open_occupancy(folders / name)
    assert len(found) == len(list(found)) == 1
    assert found.keys("train") == found.keys()
    assert not found.keys("test")
    return found, found[found.keys()[0]]


def test_formats_are_detected(folders):
    assert open_occupancy(folders / "nyu").format == "nyu"
    assert open_occupancy(folders / "nyu" / "NYUtrain").format == "nyu"
    assert open_occupancy(folders / "embodied").format == "embodied"
    assert open_occupancy(folders / "embodied" / "occscannet").format == "occscannet"
    assert open_occupancy(folders / "npz").format == "npz"


def test_npz_gives_all_back(made, folders):
    _, found = back(folders, "npz")
    assert found.key == made.key and found.camera == made.camera
    assert found.fine_classes == made.fine_classes and found.split == "train"
    for name in ("labels", "fine", "instance", "in_frustum", "hits", "free"):
        assert np.array_equal(getattr(found.occ, name), getattr(made.occ, name)), name
    assert np.array_equal(found.colour, made.colour)
    assert np.array_equal(found.depth_m, made.depth_m)
    assert np.array_equal(found.camera_to_room, made.camera_to_room)
    assert np.array_equal(found.occ.region.region_to_room, made.occ.region.region_to_room)


def test_nyu_gives_labels_camera_and_pictures_back(made, folders):
    _, found = back(folders, "nyu")
    assert np.array_equal(found.occ.labels, made.occ.labels)
    assert found.camera == made.camera
    region_to_room = made.occ.region.region_to_room
    assert np.allclose(region_to_room @ found.camera_to_room, made.camera_to_room, atol=1e-6)
    assert np.abs(found.depth_m - made.depth_m).max() < 0.00051
    assert np.abs(found.colour.astype(int) - made.colour).mean() < 2


def test_occscannet_gives_labels_in_the_room_back(made, folders):
    for name in ("embodied", "embodied/occscannet"):
        found = open_occupancy(folders / name)
        sample = found[found.keys()[0]]
        assert sample.scene_id == "scene0000_00"
        assert np.allclose(sample.camera_to_room, made.camera_to_room, atol=1e-9)
        assert np.array_equal(sample.occ.labels, np.rot90(made.occ.labels))
        assert sample.camera.fx_px == pytest.approx(made.camera.fx_px)
        assert sample.camera.cx_px == pytest.approx(320.5)
        first, second = sample.occ.region.centers_m(), made.occ.region.centers_m()
        assert np.allclose(np.rot90(second), first, atol=1e-4)


def test_masks_are_made_of_the_depth(made, folders):
    _, found = back(folders, "nyu")
    agree = np.mean(found.occ.visible[made.occ.visible])
    assert agree > 0.9
    assert np.mean(made.occ.visible[found.occ.visible]) > 0.9
    free = found.occ.free
    assert free.any() and not found.occ.labels[free].any()
    assert not (free & ~found.occ.in_frustum).any()
    assert found.facts["hits"] == "first surface, from depth"


def test_without_depth_the_masks_are_empty_with_a_note(folders, tmp_path):
    shutil.copytree(folders / "nyu", tmp_path / "nyu")
    (tmp_path / "nyu" / "NYUtrain" / f"{KEY}.png").unlink()
    sample = open_occupancy(tmp_path / "nyu")[KEY]
    assert not sample.occ.hits.any() and not sample.occ.free.any()
    assert sample.occ.in_frustum.any()
    assert sample.facts["hits"] == "none, because there is no depth"


def test_a_picture_of_another_shape_is_refused(folders, tmp_path):
    from PIL import Image

    shutil.copytree(folders / "nyu", tmp_path / "nyu")
    picture = tmp_path / "nyu" / "NYUtrain" / f"{KEY}_color.jpg"
    Image.open(picture).resize((640, 360)).save(picture)
    with pytest.raises(DamagedFileError, match=r"aspect ratio of NYUv2 \(640x480\), got 640x360"):
        open_occupancy(tmp_path / "nyu")[KEY]
    Image.open(picture).resize((320, 240)).save(picture)
    assert open_occupancy(tmp_path / "nyu")[KEY].colour.shape == (480, 640, 3)


def test_a_bin_alone_is_read(made, folders):
    found = open_occupancy(folders / "nyu" / "NYUtrain" / f"{KEY}.bin")
    assert np.array_equal(found[KEY].occ.labels, made.occ.labels)


def test_preprocessed_labels_may_lie_elsewhere(folders, tmp_path):
    shutil.copytree(folders / "nyu" / "NYUtrain", tmp_path / "depthbin" / "NYUtrain")
    shutil.copytree(folders / "nyu" / "base", tmp_path / "pre" / "base")
    for file in (tmp_path / "depthbin" / "NYUtrain").glob("*.bin"):
        file.write_bytes(b"")  # As after --short-bin: only its name is looked at.
    with pytest.raises(DamagedFileError, match="0 bytes is not a possible file size"):
        open_occupancy(tmp_path / "depthbin")[KEY]
    found = open_occupancy(tmp_path / "depthbin", labels=tmp_path / "pre")
    assert found[KEY].occ.labels.any()


def test_pickles_of_numpy_and_python_2_are_read(folders, tmp_path):
    """What MonoScene's own preprocessing leaves, by whatever Python ran it."""
    shutil.copytree(folders / "nyu", tmp_path / "nyu")
    path = tmp_path / "nyu" / "base" / "NYUtrain" / f"{KEY}.pkl"
    stored = pickle.loads(path.read_bytes())
    for protocol in (2, 4):
        path.write_bytes(pickle.dumps(stored, protocol))
        assert open_occupancy(tmp_path / "nyu")[KEY].occ.labels.any()


def test_a_hostile_pickle_in_a_data_set_is_refused(folders, tmp_path):
    shutil.copytree(folders / "embodied" / "occscannet", tmp_path / "o")
    path = tmp_path / "o" / "gathered_data" / "scene0000_00" / "00000.pkl"
    path.write_bytes(b"cos\nsystem\n(S'touch hostile'\ntR.")
    with pytest.raises(DamagedFileError, match=r"refers to os\.system, which is not allowed"):
        next(iter(open_occupancy(tmp_path / "o")))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"target_1_4": np.zeros((60, 60, 35), np.uint8)}, "got uint8 (60, 60, 35)"),
        (
            {"target_1_4": np.full((60, 60, 36), 12, np.uint8)},
            "class ids from 0 to 11, or 255",
        ),
        ({"cam_pose": np.zeros((4, 4))}, "the camera pose is not a rotation and a translation"),
        (
            {"cam_pose": np.full((4, 4), np.nan)},
            "pose must be a (4, 4) array of finite numbers",
        ),
        ({"voxel_origin": "here"}, "the voxel origin does not consist of numbers"),
        ({"intrinsic": np.zeros((4, 4))}, "intrinsic is not a valid camera matrix"),
        ({"intrinsic": np.zeros(3)}, "the matrix must be a (3, 3) array of finite numbers"),
    ],
)
def test_broken_frames_are_named(change, words, folders, tmp_path):
    shutil.copytree(folders / "embodied" / "occscannet", tmp_path / "o")
    path = tmp_path / "o" / "gathered_data" / "scene0000_00" / "00000.pkl"
    path.write_bytes(pickle.dumps(pickle.loads(path.read_bytes()) | change))
    with pytest.raises(DamagedFileError) as caught:
        next(iter(open_occupancy(tmp_path / "o")))
    assert words in str(caught.value)


def test_a_frame_as_large_as_scannet_shot_it_becomes_640x480(folders, tmp_path):
    from PIL import Image

    shutil.copytree(folders / "embodied" / "occscannet", tmp_path / "o")
    picture = tmp_path / "o" / "posed_images" / "scene0000_00" / "00000.jpg"
    Image.open(picture).resize((1296, 968)).save(picture)
    path = tmp_path / "o" / "gathered_data" / "scene0000_00" / "00000.pkl"
    stored = pickle.loads(path.read_bytes())
    stored["intrinsic"] = np.array([[1170.0, 0, 647.5], [0, 1170, 483.5], [0, 0, 1]])
    path.write_bytes(pickle.dumps(stored))
    camera = next(iter(open_occupancy(tmp_path / "o"))).camera
    assert (camera.width_px, camera.height_px) == (640, 480)
    assert camera.fx_px == pytest.approx(1170 * 640 / 1296)
    assert camera.cx_px == pytest.approx(320) and camera.cy_px == pytest.approx(240)


def test_a_scene_package_is_read(folders):
    path = folders / "embodied" / "scene_occ" / "global_occ_package" / "scene0000_00.pkl"
    scene = read_scene(path)
    cells = np.round((scene.origin_m - synthetic.ORIGIN_M) / 0.08)
    assert np.allclose(scene.origin_m, synthetic.ORIGIN_M + cells * 0.08, atol=1e-5)
    assert scene.seen.any() and len(scene.images) == 1


def test_a_hostile_npz_is_refused(folders, tmp_path):
    (tmp_path / "train").mkdir()
    (tmp_path / "train" / "a.npz").write_bytes(b"PK nothing")
    with pytest.raises(DamagedFileError):
        next(iter(open_occupancy(tmp_path, "npz")))
    np.savez(tmp_path / "train" / "a.npz", labels=np.zeros(3, np.uint8))
    with pytest.raises(DamagedFileError, match="does not contain the array"):
        next(iter(open_occupancy(tmp_path, "npz")))


def test_wrong_folders_are_named(tmp_path, folders):
    with pytest.raises(InputError, match="not an occupancy data set"):
        open_occupancy(tmp_path)
    with pytest.raises(InputError, match="not found"):
        open_occupancy(tmp_path / "none")
    with pytest.raises(UnknownNameError, match="did you mean 'nyu'"):
        open_occupancy(tmp_path, "nyuv2")
    with pytest.raises(InputError, match="no files found that match gathered_data"):
        open_occupancy(tmp_path, "occscannet")
    with pytest.raises(UnknownNameError, match="no sample is named"):
        open_occupancy(folders / "nyu")["house"]


def test_unknown_survives_a_way_through_every_format(tmp_path):
    aside = synthetic.sample(eye_m=(1.0, 0.5, 1.5))
    aside.facts.pop("first_seen")
    for name in ("nyu", "occscannet", "npz"):
        export_samples([aside], name, tmp_path / name)
        sample = next(iter(open_occupancy(tmp_path / name)))
        assert np.array_equal(sample.occ.labels, aside.occ.labels), name
        export_samples([aside], name, tmp_path / f"{name}e", ExportRule(unknown="empty"))
        assert next(iter(open_occupancy(tmp_path / f"{name}e"))).occ.labels.max() <= 11
