"""NYUv2: the loaders' arithmetic on our export meets the pixels that saw the cells."""

import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from tests.minecraftocc.exchange import page_loader, synthetic

from world2minecraft.core.errors import ConflictError, InputError, UnknownNameError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.formats.sscnet import downsample_labels, read_bin
from world2minecraft.minecraftocc.exporters import ExportRule, export_samples
from world2minecraft.minecraftocc.importers import ImportedSet

KEY = "house_0001-t0-00000"


@pytest.fixture(scope="module")
def made():
    return synthetic.sample(quarters=0)


@pytest.fixture(scope="module")
def exported(made, tmp_path_factory):
    out = tmp_path_factory.mktemp("nyu")
    export_samples([made], "nyu", out)
    return out


def test_every_file_and_key_is_there(exported):
    folder = exported / "NYUtrain"
    assert sorted(path.name for path in folder.iterdir()) == [
        f"{KEY}.bin", f"{KEY}.png", f"{KEY}_color.jpg"
    ]  # fmt: skip
    loaded = page_loader.load_nyu(exported, "train", KEY)
    kinds = {
        name: (value.dtype.str, value.shape)
        for name, value in loaded.stored.items()
        if isinstance(value, np.ndarray)
    }
    assert kinds == {
        "cam_pose": ("<f4", (4, 4)),
        "voxel_origin": ("<f4", (3,)),
        "target_1_4": ("|u1", (60, 36, 60)),
        "target_1_16": ("|u1", (15, 9, 15)),
    }
    assert loaded.stored["name"] == KEY
    assert loaded.image.shape == (480, 640, 3)
    assert Image.open(folder / f"{KEY}.png").mode == "I;16"


def test_the_target_is_x_z_y(made, exported):
    stored = page_loader.load_nyu(exported, "train", KEY).stored["target_1_4"]
    assert np.array_equal(stored, np.moveaxis(made.occ.labels, 2, 1))


@pytest.mark.parametrize("quarters", range(4))
def test_pixels_meet_the_cells_that_they_see(quarters, tmp_path):
    """Of all pixels that see a cell of the region, by depth: and no other reading of the axes."""
    made = _turned_sample(quarters)
    export_samples([made], "nyu", tmp_path)
    loaded = page_loader.load_nyu(tmp_path, "train", KEY)
    seen = made.facts["first_seen"]
    truth = np.where(seen >= 0, made.occ.labels.reshape(-1)[seen], 254)
    sees = truth != 254
    found = page_loader.first_seen_labels(loaded, page_loader.NYU_K)
    assert sees.mean() > 0.35
    assert np.mean(found[sees] == truth[sees]) > 0.998
    wrong = loaded._replace(target=loaded.target.transpose(1, 0, 2))
    assert (
        np.mean(page_loader.first_seen_labels(wrong, page_loader.NYU_K)[sees] == truth[sees]) < 0.85
    )


def test_projected_cells_meet_the_pixels_that_see_them(made, exported):
    loaded = page_loader.load_nyu(exported, "train", KEY)
    seen = made.facts["first_seen"]
    at = seen[loaded.pixels[..., 1].clip(0, 479), loaded.pixels[..., 0].clip(0, 639)]
    visible = made.occ.visible & loaded.in_view & (at >= 0)
    met = made.occ.labels.reshape(-1)[at[visible]]
    share = {axes: np.mean(loaded.target.transpose(axes)[visible] == met)
             for axes in ((0, 1, 2), (1, 0, 2))}  # fmt: skip
    assert share[0, 1, 2] > 0.97  # The rest lies behind an edge of another cell.
    assert share[1, 0, 2] < 0.8


def test_the_masks_of_view_are_the_same(made, exported):
    from world2minecraft.minecraftocc.formats.label_grids import box_cells_in_image, region_box

    loaded = page_loader.load_nyu(exported, "train", KEY)
    ours = box_cells_in_image(region_box(made), made.camera)
    assert np.mean(ours != loaded.in_view) < 1e-4  # Ties of rounding and float32.


def test_symphonies_and_iso_read_the_same_depth(made, exported):
    """One divides by 8000, the other turns the bits by three and divides by 1000."""
    raw = np.array(Image.open(exported / "NYUtrain" / f"{KEY}.png"))
    turned = (np.right_shift(raw, 3) | np.left_shift(raw, 13)) / 1000.0
    assert np.array_equal(turned, raw / 8000.0)
    assert np.abs(raw / 8000.0 - made.depth_m).max() <= 0.00051


def test_preprocessing_the_bin_gives_the_pickle(exported):
    stored = page_loader.load_nyu(exported, "train", KEY).stored
    frame = read_bin(exported / "NYUtrain" / f"{KEY}.bin")
    assert np.array_equal(downsample_labels(frame.labels, 4), stored["target_1_4"])
    assert np.array_equal(downsample_labels(frame.labels, 16), stored["target_1_16"])
    assert np.array_equal(frame.camera_to_world, stored["cam_pose"])
    assert np.array_equal(frame.origin_m, stored["voxel_origin"])


def test_the_official_division_makes_sixty_cells(exported):
    """Rounded up without care, it makes 61 of some origins, and the loaders fail."""
    origin = page_loader.load_nyu(exported, "train", KEY).stored["voxel_origin"]
    bounds = np.zeros((3, 2))
    bounds[:, 0], bounds[:, 1] = origin, origin + np.array([4.8, 4.8, 2.88])
    assert np.ceil((bounds[:, 1] - bounds[:, 0]) / 0.08).tolist() == [60, 60, 36]


CAMERAS = {
    "half a pixel off": (Camera(640, 480, 518.8579, 518.8579, 320, 240), True),
    "twice as large": (Camera(1280, 960, 1037.7158, 1037.7158, 640, 480), False),
    "wider and longer": (Camera(960, 540, 500.0, 500.0, 480, 270), False),
    "smaller": (Camera(320, 240, 250.0, 250.0, 160, 120), False),
}


@pytest.mark.parametrize("name", CAMERAS)
def test_other_cameras_are_resampled(name, tmp_path):
    camera, same = CAMERAS[name]
    made = synthetic.sample(camera=camera)
    report = export_samples([made], "nyu", tmp_path)
    assert bool(report.notes) != same
    loaded = page_loader.load_nyu(tmp_path, "train", KEY)
    truth = synthetic.sample()
    seen = truth.facts["first_seen"]
    labels = np.where(seen >= 0, truth.occ.labels.reshape(-1)[seen], 254)
    sees = labels != 254
    found = page_loader.first_seen_labels(loaded, page_loader.NYU_K, 0.02)
    assert np.mean(found[sees] == labels[sees]) > 0.95, name
    difference = np.abs(loaded.image.astype(int) - truth.colour)[sees].mean()
    assert difference < 4


@pytest.mark.parametrize(
    ("camera", "words"),
    [
        (
            Camera(640, 480, 700.0, 700.0, 320, 240),
            f"{KEY}: the camera covers 49.1 x 37.8 degrees, but the format needs 63.3 x 49.6; use "
            "a wider field of view, or export to occscannet or npz",
        ),
        (
            Camera(320, 240, 200.0, 200.0, 160, 120, (0.1, 0, 0, 0, 0)),
            f"{KEY}: the camera has lens distortion; undistort the images or render them "
            "without it",
        ),
    ],
)
def test_cameras_that_do_not_fit_are_refused(camera, words, tmp_path):
    with pytest.raises(InputError) as caught:
        export_samples([synthetic.sample(camera=camera)], "nyu", tmp_path)
    assert str(caught.value) == words


def test_splits_go_to_their_folders(tmp_path):
    small = [_small(f"a-{split or 'none'}", split) for split in ("train", "test", "")]
    report = export_samples(small, "nyu", tmp_path)
    assert (tmp_path / "NYUtest" / "a-test.bin").is_file()
    assert (tmp_path / "base" / "NYUtest" / "a-test.pkl").is_file()
    assert (tmp_path / "NYUtrain" / "a-none.bin").is_file()
    assert "1 samples have no split and were written to NYUtrain" in report.notes


def test_an_export_goes_on_where_it_stopped(made, tmp_path):
    first = export_samples([made, _small("b", "test")], "nyu", tmp_path, limit=1)
    assert (first.written, first.passed_over) == (1, 0)
    again = export_samples([made, _small("b", "test")], "nyu", tmp_path)
    assert (again.written, again.passed_over) == (1, 1)


def test_the_same_samples_give_the_same_bytes(made, tmp_path):
    export_samples([made], "nyu", tmp_path / "a")
    export_samples([made], "nyu", tmp_path / "b")
    files = [path.relative_to(tmp_path / "a") for path in (tmp_path / "a").rglob("*.*")]
    assert len(files) == 5
    assert all(
        (tmp_path / "a" / f).read_bytes() == (tmp_path / "b" / f).read_bytes() for f in files
    )


def test_other_choices_do_not_mix_in_one_folder(made, tmp_path):
    export_samples([made], "nyu", tmp_path)
    with pytest.raises(ConflictError, match="contains an export with unknown 'keep'"):
        export_samples([made], "nyu", tmp_path, ExportRule(unknown="empty"))
    with pytest.raises(ConflictError, match="format 'nyu'"):
        export_samples([made], "npz", tmp_path)


def test_unknown_cells_are_kept_or_made_empty(tmp_path):
    aside = synthetic.sample(eye_m=(1.0, 0.5, 1.5))  # Its region reaches out of the room.
    assert (aside.occ.labels == 255).any()
    export_samples([aside], "nyu", tmp_path, ExportRule(unknown="empty"))
    stored = page_loader.load_nyu(tmp_path, "train", KEY).stored["target_1_4"]
    assert stored.max() <= 11


def test_cells_outside_the_picture_may_be_left_out(made, tmp_path):
    export_samples([made], "nyu", tmp_path, ExportRule(in_view=True))
    loaded = page_loader.load_nyu(tmp_path, "train", KEY)
    outside = loaded.target[~loaded.in_view]
    assert np.mean(outside == 255) > 0.999
    known = loaded.in_view & (made.occ.labels != 255)
    assert np.mean(loaded.target[known] == made.occ.labels[known]) > 0.999


def test_a_short_bin_has_its_head_alone(made, tmp_path):
    export_samples([made], "nyu", tmp_path, ExportRule(short_bin=True))
    assert (tmp_path / "NYUtrain" / f"{KEY}.bin").stat().st_size == 76


def test_invalid_requests_are_refused(made, tmp_path):
    with pytest.raises(UnknownNameError, match="did you mean 'nyu'"):
        export_samples([made], "nyuu", tmp_path)
    with pytest.raises(UsageError, match="no samples to export in split test"):
        export_samples([made], "nyu", tmp_path, split="test")
    with pytest.raises(UnknownNameError, match="treatment of unknown cells"):
        ExportRule(unknown="none")


def test_a_data_set_that_was_made_anew_is_not_taken_for_exported(made, tmp_path):
    """Its samples have the same keys, and other pictures."""

    sample = replace(made, facts={})

    def a_set(sha256):
        return ImportedSet(tmp_path, "store", {made.key: "train"}, lambda _: sample, sha256=sha256)

    for _ in range(2):
        report = export_samples(a_set("one"), "npz", tmp_path / "out")
    assert report.passed_over == 1
    with pytest.raises(ConflictError, match="an export of another data set or of an earlier"):
        export_samples(a_set("other"), "npz", tmp_path / "out")


def test_a_list_names_what_earlier_runs_have_exported(made, tmp_path):
    for split in ("train", "test"):
        export_samples([replace(made, key=split, split=split, facts={})], "npz", tmp_path)
    told = json.loads((tmp_path / "index.json").read_text())
    assert told["keys"] == {"train": "train", "test": "test"}


def test_the_choices_are_written_down(exported):
    assert json.loads((exported / "export.json").read_text())["unknown"] == "keep"


def _turned_sample(quarters: int):
    views = [
        ((2.4, 0.5, 1.5), (2.5, 4.0, 0.9)),
        ((4.4, 3.0, 1.5), (0.5, 3.4, 0.9)),
        ((2.4, 6.0, 1.5), (2.2, 2.0, 0.9)),
        ((0.5, 3.0, 1.5), (4.4, 3.2, 0.9)),
    ]
    eye, target = views[quarters]
    return synthetic.sample(eye_m=eye, target_m=target, quarters=quarters)


def _small(key: str, split: str):
    return synthetic.sample(key, split=split, camera=Camera(320, 240, 250.0, 250.0, 160, 120))
