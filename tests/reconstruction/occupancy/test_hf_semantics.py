"""Segmenters of the transformers library: tiny ones with random weights, made here."""

import sys

import numpy as np
import pytest
from tests.reconstruction.occupancy.tiny_segmenters import KINDS, NAMES, READY, write_segmenter

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    MissingExtraError,
    UnknownNameError,
    UsageError,
)
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.reconstruction.occupancy.label_names import label_classes
from world2minecraft.reconstruction.occupancy.semantic_fusion import segmenter

COLOUR = np.random.default_rng(3).integers(0, 256, (48, 64, 3), dtype=np.uint8)
CLASSES = label_classes(NAMES, read_vocabulary().label_table()).matrix
EACH = np.zeros((len(NAMES), CLASS_COUNT), np.float32)
EACH[range(len(NAMES)), range(len(NAMES))] = 1  # Each label as a class of its own.


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    pytest.importorskip("torch")
    pytest.importorskip("transformers")
    made = {}

    def folder(kind: str):
        if kind not in made:
            made[kind] = write_segmenter(kind, tmp_path_factory.mktemp(kind))
        return made[kind]

    return folder


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_gives_shares_of_classes_and_the_same_twice(folders, kind):
    model = segmenter(f"hf:{folders(kind)}")
    assert model.labels == tuple(NAMES)
    found = model.predict(COLOUR, CLASSES)
    assert found.shape[2] == CLASS_COUNT and found.dtype == np.float32
    assert min(found.shape[:2]) > 1
    assert found.min() >= 0 and found.sum(axis=2).max() <= 1 + 1e-5
    assert found[..., 0].max() == 0, "empty is never voted for"
    assert found.std(axis=(0, 1)).max() > 1e-6, "all pixels look alike"
    again = segmenter(f"hf:{folders(kind)}").predict(COLOUR, CLASSES)
    assert again.tobytes() == found.tobytes()
    every = model.predict(COLOUR, EACH)
    assert np.median(every.sum(axis=2)) == pytest.approx(1)  # Less where no mask says anything.
    np.testing.assert_allclose(found[..., 3], every[..., 0], atol=1e-6)  # wall


def test_a_semantic_one_is_what_the_library_says(folders):
    import torch
    import transformers

    colour = np.random.default_rng(1).integers(0, 256, (64, 64, 3), dtype=np.uint8)
    kind = transformers.SegformerForSemanticSegmentation
    network = kind.from_pretrained(folders("segformer")).eval()
    pixels = torch.tensor((colour / 255 - 0.5).transpose(2, 0, 1)[None] / 0.5, dtype=torch.float32)
    with torch.no_grad():
        expected = network(pixels).logits[0].softmax(dim=0).numpy()
    got = segmenter(f"hf:{folders('segformer')}").predict(colour, EACH)
    np.testing.assert_allclose(got[..., : len(NAMES)], np.moveaxis(expected, 0, 2), atol=1e-5)


@pytest.mark.parametrize("kind", ["mask2former", "maskformer", "oneformer"])
def test_universal_model_agrees_with_the_library(folders, kind):
    """Its label of most score at each pixel, by the processor's sum over masks."""
    import torch

    model = segmenter(f"hf:{folders(kind)}")
    got = model.predict(COLOUR, EACH)[..., : len(NAMES)]
    values = np.asarray(model.predict(COLOUR, EACH))
    assert values.shape == (*got.shape[:2], CLASS_COUNT)
    from world2minecraft.external_models.transformers_hub import preprocess

    with torch.inference_mode():
        pixels = torch.from_numpy(preprocess(COLOUR, READY))
        found = model._network(pixel_values=pixels, **model._told)
    kinds = found.class_queries_logits.softmax(dim=-1)[..., :-1]
    scores = torch.einsum("bqc,bqhw->bchw", kinds, found.masks_queries_logits.sigmoid())[0]
    labels = scores.argmax(dim=0).numpy()
    assert (got.argmax(axis=2) == labels).mean() > 0.999


def test_a_state_of_a_model_is_told_from_another(folders, tmp_path):
    one = segmenter(f"hf:{folders('segformer')}")
    assert one.identity == segmenter(f"hf:{folders('segformer')}").identity
    other = segmenter(f"hf:{write_segmenter('segformer', tmp_path, seed=1)}")
    assert one.identity != other.identity


def test_only_its_config_is_read_before_the_first_picture(folders, tmp_path):
    folder = write_segmenter("segformer", tmp_path)
    (folder / "model.safetensors").write_bytes(b"no weights")
    model = segmenter(f"hf:{folder}")
    with pytest.raises(InputError, match="cannot be loaded") as caught:
        model.predict(COLOUR, CLASSES)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("file", "content", "reason"),
    [
        ("config.json", b"{", "cannot be loaded"),
        (
            "config.json",
            b'{"model_type": "bert"}',
            "supported segmentation model: bert; supported: beit",
        ),
        (
            "preprocessor_config.json",
            b'{"resample": 99}',
            "preprocessor_config.json is not valid: 99",
        ),
    ],
)
def test_what_is_no_segmenter_is_refused_in_one_line(folders, tmp_path, file, content, reason):
    folder = write_segmenter("segformer", tmp_path)
    (folder / file).write_bytes(content)
    with pytest.raises(InputError, match=reason) as caught:
        segmenter(f"hf:{folder}").predict(COLOUR, CLASSES)
    assert "\n" not in str(caught.value)


def test_lacking_weights_are_not_drawn_by_chance(folders, tmp_path):
    from safetensors.numpy import load_file, save_file

    folder = write_segmenter("segformer", tmp_path)
    weights = load_file(folder / "model.safetensors")
    del weights["decode_head.classifier.weight"]
    save_file(weights, folder / "model.safetensors", metadata={"format": "pt"})
    with pytest.raises(DamagedFileError, match="weights lack decode_head"):
        segmenter(f"hf:{folder}").predict(COLOUR, CLASSES)


def test_oneformer_without_its_tokenizer_says_so(folders, tmp_path):
    folder = write_segmenter("oneformer", tmp_path)
    (folder / "vocab.json").unlink()
    with pytest.raises(
        InputError, match=r"contains no tokenizer file \(tokenizer.json, vocab.json"
    ):
        segmenter(f"hf:{folder}").predict(COLOUR, CLASSES)


def test_names_are_checked():
    with pytest.raises(UnknownNameError, match="no segmenter is named 'hg'; known: hf"):
        segmenter("hg:a/b")
    with pytest.raises(UsageError, match="such as hf:ORG/NAME"):
        segmenter("hf")


def test_without_the_libraries_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'world2minecraft\[hf\]'"):
        segmenter("hf:a/b")
