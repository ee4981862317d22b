"""Nonsense numbers in an occupancy data set of any format: it is read, or refused in one line."""

import shutil

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from tests.hostile_files import PICKS, limited_memory, replace_in
from tests.minecraftocc.exchange import synthetic

from world2minecraft.core.errors import DamagedFileError, World2MinecraftError
from world2minecraft.minecraftocc.exporters import export_samples
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.minecraftocc.importers.embodied import open_scenes
from world2minecraft.minecraftocc.importers.format_detection import IMPORTED

# Each format with the exporter that writes it, its folder, and the files that hold numbers.
FORMATS = {
    "nyu": ("nyu", ".", "base/*/*.pkl"),
    "nyu_bin": ("nyu", "NYUtrain", "*.bin"),
    "occscannet": ("embodied", "occscannet", "gathered_data/*/*.pkl"),
    "embodied": ("embodied", ".", "scene_occ/*/*/*.pkl"),
    "embodied_scene": ("embodied", ".", "scene_occ/global_occ_package/*.pkl"),
    "npz": ("npz", ".", "*/*.npz"),
}


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    root = tmp_path_factory.mktemp("formats")
    sample = synthetic.sample(eye_m=(4.4, 3.0, 1.5), target_m=(0.5, 3.4, 0.9), quarters=1)
    sample.facts.pop("first_seen")
    for name in ("nyu", "embodied", "npz"):
        export_samples([sample], name, root / name)
    return {name: root / made / inner for name, (made, inner, _) in FORMATS.items()}


def read_all(folder, name):
    for sample in open_occupancy(folder):
        assert np.isfinite(sample.occ.region.region_to_room).all()
    if name.startswith("embodied"):
        scenes = open_scenes(folder)
        for scene in scenes.splits:
            assert np.isfinite(scenes.read(scene).origin_m).all()


def test_every_format_is_tried():
    assert {name.split("_")[0] for name in FORMATS} == set(IMPORTED) - {"store"}


@pytest.mark.parametrize("name", FORMATS)
def test_the_data_sets_are_read_unchanged(name, folders):
    assert list(folders[name].glob(FORMATS[name][2]))
    read_all(folders[name], name)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", FORMATS)
@settings(max_examples=20, suppress_health_check=list(HealthCheck), deadline=None)
@given(picks=PICKS)
def test_extreme_numbers_in_a_data_set(name, folders, tmp_path_factory, picks):
    folder = tmp_path_factory.mktemp(name) / folders[name].name
    shutil.copytree(folders[name], folder)
    files = sorted(folder.glob(FORMATS[name][2]))
    replace_in(files[int(picks[-1][0] * 9973) % len(files)], picks)
    try:
        with limited_memory():
            read_all(folder, name)
    except World2MinecraftError as error:
        assert error.exit_code == 3
        assert "\n" not in str(error) and len(str(error)) < 1500
    shutil.rmtree(folder)


@pytest.mark.parametrize(("at", "words"), [(0, "voxel origin is up to 1e"), (24, "camera pose")])
def test_the_place_of_a_bin_is_checked(at, words, folders, tmp_path):
    path = next(folders["nyu_bin"].glob("*.bin"))
    data = bytearray(path.read_bytes())
    data[at : at + 4] = np.float32(1e30).tobytes()
    (tmp_path / "a.bin").write_bytes(data)
    with pytest.raises(DamagedFileError, match=words) as caught:
        next(iter(open_occupancy(tmp_path / "a.bin")))
    assert "\n" not in str(caught.value)
