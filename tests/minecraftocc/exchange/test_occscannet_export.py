"""OccScanNet and EmbodiedOcc-ScanNet: their loaders' arithmetic on our exports."""

import pickle

import numpy as np
import pytest
from tests.minecraftocc.exchange import page_loader, synthetic

from world2minecraft.core.errors import ConflictError, InputError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.exporters import ExportRule, export_samples
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.minecraftocc.importers.embodied import open_scenes

VIEWS = [
    ((2.4, 0.5, 1.5), (2.5, 4.0, 0.9), 0),
    ((4.4, 3.0, 1.5), (0.5, 3.4, 0.9), 1),
    ((2.4, 6.0, 1.5), (2.2, 2.0, 0.9), 2),
    ((0.5, 3.0, 1.5), (4.4, 3.2, 0.9), 3),
]


def frames(scene_id="house_0001", split="train", views=VIEWS):
    return [
        synthetic.sample(
            f"{scene_id}-t0-{number:05d}",
            eye_m=eye,
            target_m=target,
            quarters=quarters,
            scene_id=scene_id,
            split=split,
            frame=number,
        )
        for number, (eye, target, quarters) in enumerate(views)
    ]


@pytest.fixture(scope="module")
def made():
    return [*frames(), *frames("house_0007", "test", VIEWS[:1])]


@pytest.fixture(scope="module")
def exported(made, tmp_path_factory):
    out = tmp_path_factory.mktemp("data")
    export_samples(made, "embodied", out)
    return out


@pytest.fixture(scope="module")
def flat(exported):
    return exported / "occscannet"


def opened(path):
    with path.open("rb") as stream:
        return pickle.load(stream)


def test_every_file_key_shape_and_type_is_there(flat):
    assert sorted(path.name for path in flat.iterdir()) == [
        "gathered_data", "names.json", "posed_images", "test_final.txt", "train_final.txt",
        "train_subscenes.txt", "val_subscenes.txt",
    ]  # fmt: skip
    stored = opened(flat / "gathered_data" / "scene0000_00" / "00002.pkl")
    assert list(stored) == [
        "img", "depth_gt", "cam_pose", "intrinsic", "voxel_origin", "target_1_4", "target_1_16"
    ]  # fmt: skip
    assert stored["img"] == "./data/occscannet/posed_images/scene0000_00/00002.jpg"
    assert stored["depth_gt"] == "./data/occscannet/posed_images/scene0000_00/00002.png"
    assert stored["cam_pose"].shape == stored["intrinsic"].shape == (4, 4)
    assert stored["voxel_origin"].shape == (3,)
    assert (stored["target_1_4"].dtype, stored["target_1_4"].shape) == (np.uint8, (60, 60, 36))
    assert (stored["target_1_16"].dtype, stored["target_1_16"].shape) == (np.uint8, (15, 15, 9))


def test_lists_name_the_frames_by_split(flat):
    lines = (flat / "train_subscenes.txt").read_text().splitlines()
    assert lines == [f"gathered_data/scene0000_00/{number:05d}.pkl" for number in range(4)]
    assert (flat / "val_subscenes.txt").read_text() == "gathered_data/scene0001_00/00000.pkl\n"
    assert (flat / "test_final.txt").read_text() == "gathered_data/scene0001_00/00000.pkl\n"


@pytest.mark.parametrize("number", range(4))
def test_pixels_meet_the_cells_that_they_see(number, made, flat):
    loaded = page_loader.load_occscannet(flat, f"gathered_data/scene0000_00/{number:05d}.pkl")
    seen = made[number].facts["first_seen"]
    truth = np.where(seen >= 0, made[number].occ.labels.reshape(-1)[seen], 254)
    sees = truth != 254
    found = page_loader.first_seen_labels(loaded, loaded.stored["K"])
    assert sees.mean() > 0.35
    assert np.mean(found[sees] == truth[sees]) > 0.998
    unswapped = loaded._replace(target=loaded.target.transpose(1, 0, 2))
    met = page_loader.first_seen_labels(unswapped, loaded.stored["K"])
    assert np.mean(met[sees] == truth[sees]) < 0.85


def test_all_frames_of_a_scene_share_one_world(flat):
    """Where boxes overlap they say the same, though their regions were turned by quarters."""
    grids = []
    for number in range(4):
        stored = opened(flat / "gathered_data" / "scene0000_00" / f"{number:05d}.pkl")
        first = np.round((stored["voxel_origin"] - synthetic.ORIGIN_M) / 0.08).astype(int)
        labels = stored["target_1_4"].transpose(1, 0, 2)
        grid = np.full((300, 300, 36), 255, np.uint8)
        x, y, _ = first + 100
        grid[x : x + 60, y : y + 60] = labels
        grids.append(grid)
    known = [grid != 255 for grid in grids]
    for one in range(3):
        both = known[one] & known[one + 1]
        assert both.sum() > 10_000
        assert np.array_equal(grids[one][both], grids[one + 1][both])


def test_a_region_turned_with_the_view_has_a_world_of_its_own(tmp_path):
    made = synthetic.sample(turn_deg=30.0, target_m=(0.5, 4.0, 0.9))
    report = export_samples([made], "occscannet", tmp_path)
    assert any("rotated with the view" in note for note in report.notes)
    loaded = page_loader.load_occscannet(tmp_path, "gathered_data/scene0000_00/00000.pkl")
    assert np.array_equal(loaded.target, made.occ.labels)
    visible = made.occ.visible & loaded.in_view
    u, v = np.moveaxis(loaded.pixels[visible], -1, 0)
    at = made.facts["first_seen"][v, u]
    met = made.occ.labels.reshape(-1)[at[at >= 0]]
    assert np.mean(loaded.target[visible][at >= 0] == met) > 0.8  # Cut aslant, cells overlap.
    with pytest.raises(InputError, match="scene packages need regions along the"):
        export_samples([made], "embodied", tmp_path / "e")


def test_any_camera_becomes_640x480(tmp_path):
    made = synthetic.sample(camera=Camera(960, 540, 500.0, 500.0, 480, 270))
    export_samples([made], "occscannet", tmp_path)
    loaded = page_loader.load_occscannet(tmp_path, "gathered_data/scene0000_00/00000.pkl")
    assert loaded.image.shape == (480, 640, 3)
    assert loaded.stored["K"][0, 0] == pytest.approx(500 * 480 / 540)
    seen = page_loader.first_seen_labels(loaded, loaded.stored["K"], 0.02)
    again = synthetic.sample(
        camera=Camera(640, 480, 500 * 480 / 540, 500 * 480 / 540, 320.0, 240.0)
    )
    first = again.facts["first_seen"]
    sees = first >= 0
    assert np.mean(seen[sees] == again.occ.labels.reshape(-1)[first[sees]]) > 0.95


def test_names_stay_when_an_export_grows(made, tmp_path):
    export_samples(made, "occscannet", tmp_path, limit=2)
    again = export_samples([made[4], *made[:4]], "occscannet", tmp_path)
    assert (again.written, again.passed_over) == (3, 2)
    lines = (tmp_path / "val_subscenes.txt").read_text()
    assert lines == "gathered_data/scene0001_00/00000.pkl\n"


def test_names_survive_a_stop(made, tmp_path):
    def stopped():
        yield from made[:2]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        export_samples(stopped(), "occscannet", tmp_path)
    assert not (tmp_path / "train_subscenes.txt").exists()
    again = export_samples(made, "occscannet", tmp_path)
    assert (again.written, again.passed_over) == (3, 2)


def test_a_frame_without_any_occupied_cell_is_in_no_final_list(tmp_path):
    bare = synthetic.sample(eye_m=(2.4, 100.0, 1.5), target_m=(2.5, 104.0, 1.5))
    export_samples([bare], "occscannet", tmp_path)
    assert (tmp_path / "train_subscenes.txt").read_text()
    assert not (tmp_path / "train_final.txt").read_text()


# Scenes.


def test_scene_packages_have_every_key(exported):
    package = opened(exported / "scene_occ" / "global_occ_package" / "scene0000_00.pkl")
    assert set(package) == {
        "scene_dim", "global_labels", "global_pts", "global_mask", "valid_img_paths"
    }  # fmt: skip
    shape = tuple(package["scene_dim"])
    assert package["global_labels"].shape == package["global_mask"].shape == shape
    assert package["global_pts"].shape == (*shape, 3)
    assert package["global_mask"].dtype == bool
    assert package["valid_img_paths"] == [
        f"./data/occscannet/posed_images/scene0000_00/{number:05d}.jpg" for number in range(4)
    ]
    folder = exported / "scene_occ"
    assert (folder / "train_online.txt").read_text() == "scene0000_00\n"
    assert (folder / "test_online.txt").read_text() == "scene0001_00\n"


def test_a_scene_is_the_room_that_its_frames_saw(exported):
    package = opened(exported / "scene_occ" / "global_occ_package" / "scene0000_00.pkl")
    labels, centres = package["global_labels"], package["global_pts"].astype(np.float64)
    cells = np.floor((centres - synthetic.ORIGIN_M) / 0.08).astype(int)
    inside = np.all((cells >= 0) & (cells < synthetic.CELLS.shape), axis=-1)
    known = labels != 255
    assert known.sum() > 100_000
    assert not (known & ~inside).any()
    assert np.array_equal(labels[known], synthetic.CELLS[tuple(cells[known].T)])


def test_masks_say_what_a_frame_sees_of_its_scene(exported, made):
    package = opened(exported / "scene_occ" / "global_occ_package" / "scene0000_00.pkl")
    union = np.zeros(package["global_mask"].shape, bool)
    for number in range(4):
        name = f"scene0000_00_{number:05d}_new.pkl"
        frame = opened(exported / "scene_occ" / "streme_occ_new_package" / "train" / name)
        assert set(frame) == {"local_label", "mask_in_global"}
        loaded = page_loader.load_occscannet(
            exported / "occscannet", f"gathered_data/scene0000_00/{number:05d}.pkl"
        )
        assert np.array_equal(frame["local_label"].transpose(1, 0, 2), loaded.target)
        mask = frame["mask_in_global"]
        assert (mask.dtype, mask.shape) == (bool, union.shape)
        assert abs(int(mask.sum()) - int(loaded.in_view.sum())) < 20
        seen = loaded.target[loaded.in_view]
        counts = np.bincount(package["global_labels"][mask], minlength=256)
        assert np.abs(counts - np.bincount(seen, minlength=256)).max() < 20
        union |= mask
    assert np.array_equal(union, package["global_mask"])


def test_a_scene_takes_its_frames_evenly(made, tmp_path):
    export_samples(made[:4], "embodied", tmp_path, ExportRule(frames_per_scene=2))
    package = opened(tmp_path / "scene_occ" / "global_occ_package" / "scene0000_00.pkl")
    assert [path[-9:-4] for path in package["valid_img_paths"]] == ["00000", "00003"]


def test_a_scene_too_large_for_the_official_operation_is_named(made, tmp_path, monkeypatch):
    monkeypatch.setattr(
        "world2minecraft.minecraftocc.exporters.embodied.OFFICIAL_CELLS", (60, 60, 36)
    )
    report = export_samples(made[:2], "embodied", tmp_path)
    assert report.notes == [
        "1 scenes exceed 60x60x36 cells, the limit of EmbodiedOcc's own code: scene0000_00"
    ]


def test_a_split_after_another_leaves_its_lists_alone(made, exported, tmp_path):
    for split in ("train", "test"):
        export_samples(made, "embodied", tmp_path, split=split)
    both = {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()}
    assert both == {one.relative_to(exported) for one in exported.rglob("*") if one.is_file()}
    for path in both:
        assert (tmp_path / path).read_bytes() == (exported / path).read_bytes(), path


def test_masks_of_frames_that_are_no_longer_taken_go(made, tmp_path):
    """They are of the scene's grid before it grew, and no reader could lay them on it."""
    rule = ExportRule(frames_per_scene=2)
    for limit in (2, 3, 4):
        export_samples(made, "embodied", tmp_path, rule, limit=limit)
        scenes = open_scenes(tmp_path)
        assert len(scenes.frames["scene0000_00"]) == 2
        assert scenes.read("scene0000_00").seen.any()


def test_a_scene_of_two_splits_is_refused(tmp_path):
    both = [*frames(views=VIEWS[:1]), *frames(split="test", views=VIEWS[:2])[1:]]
    with pytest.raises(UsageError, match="house_0001 has frames in train and in test"):
        export_samples(both, "embodied", tmp_path)


def test_axes_iso_is_for_a_loader_that_swaps_nothing(made, tmp_path):
    """ISO reads target_1_4 as x, y, z; the export for it is the swap of the published order."""
    export_samples(made, "occscannet", tmp_path / "plain")
    export_samples(made, "occscannet", tmp_path / "iso", ExportRule(axes="iso"))
    name = "gathered_data/scene0000_00/00001.pkl"
    plain, iso = opened(tmp_path / "plain" / name), opened(tmp_path / "iso" / name)
    for target in ("target_1_4", "target_1_16"):
        assert np.array_equal(iso[target], plain[target].transpose(1, 0, 2))
    assert not np.array_equal(iso["target_1_4"], plain["target_1_4"])
    swapped = page_loader.load_occscannet(tmp_path / "plain", name).target
    assert np.array_equal(iso["target_1_4"], swapped)


def test_an_export_with_axes_iso_reads_back_the_same(made, tmp_path):
    export_samples(made, "occscannet", tmp_path / "plain")
    export_samples(made, "occscannet", tmp_path / "iso", ExportRule(axes="iso"))
    plain, iso = (open_occupancy(tmp_path / one) for one in ("plain", "iso"))
    for key in plain.splits:
        assert np.array_equal(plain[key].occ.labels, iso[key].occ.labels)
    with pytest.raises(ConflictError, match="contains an export with axes 'iso'"):
        export_samples(made, "occscannet", tmp_path / "iso")


@pytest.mark.parametrize("format", ["nyu", "embodied", "npz"])
def test_axes_are_an_option_of_occscannet_alone(made, tmp_path, format):
    with pytest.raises(UsageError) as caught:
        export_samples(made, format, tmp_path, ExportRule(axes="iso"))
    assert str(caught.value) == f"axes iso requires the format occscannet, got {format}"
    with pytest.raises(UsageError, match="no order of axes is named 'zyx'"):
        ExportRule(axes="zyx")
