import json
import re
import sys
from dataclasses import replace

import pytest
from PIL import Image
from tests.minecraftocc.exchange import synthetic
from tests.minecraftocc.samples import occ_labels, random_labels, sample

from world2minecraft.core.classes import CLASS_COLOURS, CLASS_NAMES
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import InputError, MissingExtraError, UsageError
from world2minecraft.minecraftocc.exporters import export_samples
from world2minecraft.minecraftocc.formats.label_grids import cells_in_image
from world2minecraft.minecraftocc.statistics import (
    DatasetStatistics,
    count_samples,
    statistics_json,
    statistics_latex,
    statistics_text,
)
from world2minecraft.minecraftocc.statistics.dataset_statistics import (
    rooms_of,
    statistics_of,
    store_statistics,
)
from world2minecraft.minecraftocc.statistics.plots import write_plots
from world2minecraft.minecraftocc.statistics.published_figures import PUBLISHED_SETS
from world2minecraft.minecraftocc.statistics.tables import (
    align_columns,
    class_shares,
    escape_latex,
    format_count,
)
from world2minecraft.minecraftocc.statistics.types import FineCount, SceneCount
from world2minecraft.minecraftocc.store import write_store

SMALL = DatasetStatistics(
    "houses & more",
    8,
    (SceneCount("a", 5, 30_000, 9_000, 4), SceneCount("b", 3, 31_234, 8_000, 7)),
    (200_000, 5_000, 20_000, 20_234, 0, 5_000, 1_000, 0, 4_000, 0, 5_000, 1_000),
    90_500,
    (
        FineCount("minecraft:oak_planks", 90_000, 8, 8),
        FineCount("design:chair_cafe", 9_000, 6, 4),
        FineCount("minecraft:torch", 50, 1, 0),
    ),
    {"1920x1129": 8},
    {"test": 2, "train": 6},
    "60x60x36 cells of 0.08 m",
)
TEXT = """\
data set               images  scenes   rooms  classes  semantic voxels  voxels/scene  resolution
NYUv2                   1,449     464       -       13       10,786,528         23.2K     640x480
OccScanNet             65,119     674       -       13      201,215,233        298.5K     640x480
MinecraftOcc (paper)  100,165     156  ~1,000    1,452      733,280,256          4.7M   1920x1129
houses & more               8       2      11        2           61,234         30.6K   1920x1129

semantic voxels  counted as in the paper: occupied cells of the region of each image
                 (60x60x36 cells of 0.08 m) whose centres are inside the image;
                 90,500 in the complete regions, as apparently counted for NYUv2
distinct cells   17,000 in the worlds, each in 3.6 images on average
classes          2 of 3 fine classes have at least 100 pixels in 3 or more images:
                 1 blocks, 1 pieces of furniture;
                 8 of the 11 occupied classes are present
splits           test 2, train 6

class       voxels  share  NYUv2 train
ceiling      5,000   8.2%         1.3%  ######
floor       20,000  32.7%        17.8%  ########################
wall        20,234  33.0%        15.1%  ########################
window           0   0.0%         1.9%
chair        5,000   8.2%         3.0%  ######
bed          1,000   1.6%         7.3%  #
sofa             0   0.0%         4.7%
table        4,000   6.5%         4.2%  #####
television       0   0.0%         0.5%
furniture    5,000   8.2%        30.0%  ######
object       1,000   1.6%        14.2%  #

fine class            pixels  images
minecraft:oak_planks  90,000       8
design:chair_cafe      9,000       6"""


def test_the_text_is_the_papers_table_and_what_it_cannot_say():
    assert statistics_text(SMALL) == TEXT


def test_the_papers_rows_are_consistent_in_themselves():
    per_scene = [format_count(row.voxels_per_scene) for row in PUBLISHED_SETS]
    assert per_scene == ["23.2K", "298.5K", "4.7M"]  # As printed there.


def test_json_holds_every_figure_and_is_json():
    told = json.loads(json.dumps(statistics_json(SMALL), allow_nan=False))
    assert (told["voxels"], told["distinct_cells"], told["rooms"]) == (61_234, 17_000, 11)
    assert (told["fine_classes"], told["class_voxels"]["floor"]) == (2, 20_000)
    assert sum(told["class_shares"].values()) == pytest.approx(1)
    assert told["published"]["sets"][2]["voxels"] == 733_280_256


def test_latex_rows_have_eight_cells_and_escaped_names():
    lines = statistics_latex(SMALL).splitlines()
    rows = [line for line in lines if line.endswith(r"\\")]
    assert [len(re.findall(r"(?<!\\)&", row)) for row in rows] == [7] * 5
    assert rows[-1].startswith(r"houses \& more & 8 & 2 & 11 & 2 & 61,234 & 30.6K & $1920 \times")
    assert lines[1] == r"\toprule" and lines[-2] == r"\bottomrule"
    assert escape_latex(r"a_b\c%") == r"a\_b\textbackslash{}c\%"


def test_a_set_without_fine_classes_rooms_and_cells_says_so():
    bare = replace(
        SMALL, fine=None, scenes=(SceneCount("a", 8, 61_234),), sizes_px={"9x9": 5, "8x8": 3}
    )
    text = statistics_text(bare)
    assert "the 12 classes and unknown; this data set has no fine classes" in text
    assert "rooms            not known for all scenes" in text
    assert "resolutions      9x9 (5), 8x8 (3)" in text
    assert "distinct cells" not in text


def test_many_fine_classes_are_listed_from_both_ends():
    fine = tuple(FineCount(f"minecraft:b{n:03d}", 9_000 - n, 9, 9) for n in range(50))
    text = statistics_text(replace(SMALL, fine=fine))
    assert "minecraft:b007" in text and "minecraft:b042" in text
    assert "minecraft:b008" not in text
    assert "... 34 more ..." in text


def test_shares_of_nothing_are_nothing_and_columns_line_up():
    assert class_shares([7] + [0] * 11) == [0.0] * 11
    assert align_columns([("a", "bb"), ("ccc", "d")]) == ["a    bb", "ccc   d"]


@pytest.mark.parametrize(
    "statistics",
    [
        SMALL,
        replace(SMALL, fine=(), scenes=(), class_voxels=(0,) * 12),
        replace(SMALL, name="a $ and a_ $"),
    ],
    ids=["some", "nothing", "dollars"],
)
def test_plots_are_pictures_and_the_same_each_time(tmp_path, statistics):
    first = write_plots(statistics, tmp_path / "a")
    second = write_plots(statistics, tmp_path / "b")
    assert [place.name for place in first] == (
        ["classes.png", "fine_classes.png", "scenes.png"]
        if statistics.fine
        else ["classes.png", "scenes.png"]
    )
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes()
        assert Image.open(one).size[0] == 1520


COLOURS = {tuple(colour) for colour in CLASS_COLOURS[1:]}
WALL = tuple(CLASS_COLOURS[CLASS_NAMES.index("wall")])


def test_the_longest_bar_is_the_commonest_classs(tmp_path):
    place = write_plots(SMALL, tmp_path)[0]
    picture = Image.open(place).convert("RGB")
    wide = [picture.crop((0, y, picture.width, y + 1)) for y in range(picture.height)]
    counts = [{colour: n for n, colour in row.getcolors(4096)} for row in wide]
    bars = [next((c for c, n in row.items() if c in COLOURS and n > 9), None) for row in counts]
    assert next(colour for colour in bars if colour) == WALL
    assert max(row.get(WALL, 0) for row in counts) > 600


def test_plots_without_matplotlib_name_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.style", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'world2minecraft\[data\]'"):
        write_plots(SMALL, tmp_path)


@pytest.fixture
def store(tmp_path):
    samples = [
        sample(n, f"house_{n // 4:04d}", random_labels(n), "test" if n >= 8 else "train")
        for n in range(12)
    ]
    write_store(tmp_path / "data", samples)
    return tmp_path / "data", samples


def test_a_store_has_the_numbers_of_its_samples(store):
    folder, samples = store
    assert store_statistics(folder) == count_samples(samples).result("data")
    test = store_statistics(folder, "test")
    assert test == replace(count_samples(samples[8:]).result("data, test"))


def test_processes_count_what_one_counts(store, monkeypatch):
    from world2minecraft.minecraftocc.statistics import dataset_statistics as reading

    monkeypatch.setattr(reading, "PART", 5)
    assert store_statistics(store[0], jobs=2) == store_statistics(store[0])


def test_a_missing_store_or_split_is_reported(store, tmp_path):
    with pytest.raises(InputError, match="not a data set"):
        store_statistics(tmp_path / "nothing")
    with pytest.raises(UsageError, match="has no split 'val'; known splits: test, train"):
        store_statistics(store[0], "val")


def test_rooms_come_from_the_scenes_that_tell_them(tmp_path):
    scenes = [
        {"scene_id": "a", "rooms": 4},
        {"scene_id": "b"},
        "c",
        {"scene_id": "d", "rooms": "x"},
    ]
    assert rooms_of(tmp_path, {"scenes": scenes}) == {"a": 4}
    assert rooms_of(tmp_path, {}) == {}
    folder = tmp_path / "scenes"
    folder.mkdir()
    (folder / "a.poses.jsonl").write_text('{"room": 1}\n')  # dataset.json goes before.
    (folder / "b.poses.jsonl").write_text('{"room": 3}\n{"room": 0}\n\n{"room": 3}\n')
    (folder / "d.poses.jsonl").write_text('{"frame": 3}\n')
    (tmp_path / "e.poses.jsonl").write_text('{"room": 1}\n')
    scenes.append({"scene_id": "../e"})
    assert rooms_of(tmp_path, {"scenes": scenes}) == {"a": 4, "b": 2}
    (tmp_path / "worlds" / "b").mkdir(parents=True)
    (tmp_path / "worlds" / "b" / "house.json").write_text('{"rooms": [{}, {}, {}]}')
    scenes[1]["source"] = "worlds/b"
    assert rooms_of(tmp_path, {"scenes": scenes}) == {"a": 4, "b": 3}


def test_empty_labels_are_a_picture_without_voxels():
    statistics = count_samples([sample(occ=occ_labels())]).result("x")
    assert (statistics.pictures, statistics.voxels, statistics.distinct_cells) == (1, 0, 0)


def in_frustum(one):
    """The sample with the frustum of its camera."""
    region = one.occ.region
    region_to_camera = invert_rigid(one.camera_to_room) @ region.region_to_room
    inside, _, _ = cells_in_image(region.shape, region.voxel_m, region_to_camera, one.camera)
    return replace(one, occ=replace(one.occ, in_frustum=inside), facts={})


def test_exports_of_a_set_have_its_numbers(tmp_path):
    keys, splits = ("house_0001-t0-00000", "house_0001-t0-00001"), ("train", "test")
    samples = [
        in_frustum(synthetic.sample(key, frame=n, split=split))
        for n, (key, split) in enumerate(zip(keys, splits, strict=True))
    ]
    whole = count_samples(samples).result("npz")
    for format in ("npz", "nyu"):
        export_samples(samples, format, tmp_path / format)
    again = statistics_of(tmp_path / "npz")
    assert again == replace(whole, fine=again.fine)
    assert sum(one.pixels for one in again.fine) == sum(one.pixels for one in whole.fine)
    nyu = statistics_of(tmp_path / "nyu", format="nyu")
    assert (nyu.pictures, nyu.fine, nyu.splits) == (2, None, {"test": 1, "train": 1})
    assert (nyu.voxels, nyu.uncut_voxels) == (whole.voxels, whole.uncut_voxels)
    assert statistics_of(tmp_path / "npz", "test").pictures == 1
    with pytest.raises(InputError, match="contains no images in split 'val'"):
        statistics_of(tmp_path / "npz", "val")
