"""Networks of the transformers library: tiny ones with random weights, made here."""

import json
import sys

import numpy as np
import pytest

from world2minecraft.capture.stereo.monocular_depth import load_depth_model
from world2minecraft.core.errors import DamagedFileError, InputError, MissingExtraError
from world2minecraft.core.types import Camera
from world2minecraft.external_models.transformers_hub import preprocess, preprocessed_size

CAMERA = Camera(60, 40, 50.0, 50.0, 30.0, 20.0)
COLOUR = np.random.default_rng(0).integers(0, 256, (40, 60, 3), dtype=np.uint8)
READY = {
    "do_resize": True, "size": {"width": 42, "height": 42}, "keep_aspect_ratio": True,
    "ensure_multiple_of": 14, "resample": 3, "do_rescale": True, "rescale_factor": 1 / 255,
    "do_normalize": True, "image_mean": [0.485, 0.456, 0.406], "image_std": [0.229, 0.224, 0.225],
}  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    """A DepthAnything of a few thousand weights, saved as such networks are."""
    torch = pytest.importorskip("torch")
    transformers = pytest.importorskip("transformers")
    torch.manual_seed(0)
    backbone = transformers.Dinov2Config(
        hidden_size=16, num_hidden_layers=4, num_attention_heads=2, image_size=42, patch_size=14,
        out_features=["stage1", "stage2", "stage3", "stage4"], reshape_hidden_states=False,
    )  # fmt: skip
    config = transformers.DepthAnythingConfig(
        backbone_config=backbone, patch_size=14, reassemble_hidden_size=16,
        neck_hidden_sizes=[8, 8, 8, 8], fusion_hidden_size=8, head_hidden_size=4,
    )  # fmt: skip
    transformers.DepthAnythingForDepthEstimation(config).save_pretrained(tmp_path)
    (tmp_path / "preprocessor_config.json").write_text(json.dumps(READY))
    return tmp_path


def change(path, **entries):
    path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))


def test_a_network_in_a_folder_predicts_the_same_twice(folder):
    import torch

    model = load_depth_model(f"hf:{folder}")
    assert model.kind == "inverse"
    threads = torch.get_num_threads()
    first = model.predict(COLOUR, CAMERA)
    assert (first.shape, first.dtype) == ((40, 60), np.float32)
    assert np.isfinite(first).all()
    assert first.tobytes() == load_depth_model(f"hf:{folder}").predict(COLOUR, CAMERA).tobytes()
    assert torch.get_num_threads() == threads


def test_prediction_equals_the_library(folder):
    """The library's own call, on a picture that needs no resizing."""
    import torch
    import transformers

    colour = np.random.default_rng(1).integers(0, 256, (42, 42, 3), dtype=np.uint8)
    network = transformers.AutoModelForDepthEstimation.from_pretrained(folder).eval()
    values = (colour / 255 - READY["image_mean"]) / READY["image_std"]
    with torch.no_grad():
        pixels = torch.tensor(values.transpose(2, 0, 1)[None], dtype=torch.float32)
        expected = network(pixels).predicted_depth[0].numpy()
    got = load_depth_model(f"hf:{folder}").predict(colour, Camera(42, 42, 50.0, 50.0, 21.0, 21.0))
    np.testing.assert_allclose(got, expected, rtol=1e-4, atol=1e-6)


def test_a_metric_network_is_known_by_its_config(folder):
    change(folder / "config.json", depth_estimation_type="metric", max_depth=20)
    assert load_depth_model(f"hf:{folder}").kind == "metric"


def test_lacking_weights_are_not_drawn_by_chance(folder):
    from safetensors.numpy import load_file, save_file

    path = folder / "model.safetensors"
    weights = load_file(path)
    del weights["head.conv3.weight"]
    save_file(weights, path, metadata={"format": "pt"})
    with pytest.raises(DamagedFileError, match="weights lack head"):
        load_depth_model(f"hf:{folder}")


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("model.safetensors", b"no weights"),
        ("config.json", b"{"),
        ("config.json", b'{"model_type": "bert"}'),
        ("preprocessor_config.json", b"[]"),
        ("preprocessor_config.json", b'{"size": {"width": "wide", "height": 3}}'),
        ("preprocessor_config.json", b'{"resample": 99}'),
    ],
)
def test_what_is_damaged_is_refused_in_one_line(folder, file, content):
    (folder / file).write_bytes(content)
    with pytest.raises(InputError) as caught:
        load_depth_model(f"hf:{folder}")
    assert "\n" not in str(caught.value)


def test_no_folder_and_no_name_is_refused():
    pytest.importorskip("torch")
    pytest.importorskip("transformers")
    with pytest.raises(InputError, match="neither a folder nor a model name"):
        load_depth_model("hf:../nowhere/at/all")


def test_without_the_libraries_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'world2minecraft\[hf\]'"):
        load_depth_model("hf:a/b")


@pytest.mark.parametrize(
    ("size_px", "changes", "wanted"),
    [
        ((640, 480), {"size": {"width": 518, "height": 518}}, (686, 518)),
        ((640, 480), {"size": {"width": 518, "height": 518}, "keep_aspect_ratio": 0}, (518,) * 2),
        ((480, 640), {"size": {"width": 512, "height": 384}, "ensure_multiple_of": 32}, (512, 672)),
        ((640, 480), {"size": {"shortest_edge": 240}, "ensure_multiple_of": 1}, (320, 240)),
        ((800, 400), {"size": {"shortest_edge": 512, "longest_edge": 700}}, (700, 350)),
        ((640, 480), {"size": 240, "max_size": 2000, "ensure_multiple_of": 1}, (320, 240)),
        ((9, 9), {"size": 1}, (14, 14)),
        ((10, 10), {"size": 10**9}, (4088, 4088)),
    ],
)  # fmt: skip
def test_sizes(size_px, changes, wanted):
    assert preprocessed_size(size_px, {**READY, **changes}) == wanted


def test_grey_of_the_mean_becomes_zero():
    ready = {**READY, "image_mean": [0.2, 0.4, 0.6], "do_resize": False}
    values = preprocess(np.full((5, 6, 3), (51, 102, 153), np.uint8), ready)
    assert values.shape == (1, 3, 5, 6)
    assert abs(values).max() < 1e-6
