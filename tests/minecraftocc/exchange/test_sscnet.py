"""SSCNet's .bin and its rule for coarse cells, against the loaders' own slow way."""

import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.formats.sscnet import (
    CLASS_OF_CODE,
    CODE_OF_CLASS,
    downsample_labels,
    encode_bin,
    read_bin,
)

POSE = np.array([[0, 0, 1, 0.5], [-1, 0, 0, 1], [0, -1, 0, 1.5], [0, 0, 0, 1]], np.float32)


def slow_downsampled(labels, factor):
    """The rule as the page says it, one cell at a time."""
    result = np.zeros(tuple(side // factor for side in labels.shape), np.uint8)
    for cell in np.ndindex(result.shape):
        block = labels[tuple(slice(i * factor, (i + 1) * factor) for i in cell)].ravel()
        empty, unknown = np.sum(block == 0), np.sum(block == 255)
        if empty + unknown > 0.95 * factor**3:
            result[cell] = 0 if empty > unknown else 255
        else:
            result[cell] = np.argmax(np.bincount(block[(block > 0) & (block < 255)]))
    return result


@pytest.mark.parametrize("share", [0.0, 0.03, 0.06, 0.5, 1.0])
@pytest.mark.parametrize("factor", [2, 4])
def test_the_fast_rule_is_the_slow_one(share, factor):
    chance = np.random.default_rng(round(share * 100))
    labels = np.where(chance.random((16, 8, 16)) < 0.5, 0, 255).astype(np.uint8)
    filled = chance.random(labels.shape) < share
    labels[filled] = chance.integers(1, 12, int(filled.sum()))
    assert np.array_equal(downsample_labels(labels, factor), slow_downsampled(labels, factor))


def test_four_of_sixty_four_voxels_make_a_cell():
    block = np.zeros((4, 4, 4), np.uint8)
    block.reshape(-1)[:3] = 5
    assert downsample_labels(block, 4)[0, 0, 0] == 0
    block.reshape(-1)[:4] = 5
    assert downsample_labels(block, 4)[0, 0, 0] == 5


def test_sixteenths_of_fine_voxels_are_quarters_of_cells():
    chance = np.random.default_rng(3)
    cells = chance.choice(np.array([0, 0, 0, 255, 3, 11], np.uint8), (8, 8, 8))
    fine = cells.repeat(4, 0).repeat(4, 1).repeat(4, 2)
    assert np.array_equal(downsample_labels(fine, 16), downsample_labels(cells, 4))


def test_a_grid_comes_back_from_its_bin(tmp_path):
    chance = np.random.default_rng(0)
    cells = chance.choice(
        np.array([*range(12), 255], np.uint8), (60, 36, 60), p=[0.5, *[0.5 / 12] * 12]
    )
    (tmp_path / "a.bin").write_bytes(encode_bin(cells, np.array([0.1, -2, 3]), POSE))
    frame = read_bin(tmp_path / "a.bin")
    assert frame.labels.shape == (240, 144, 240)
    assert np.array_equal(downsample_labels(frame.labels, 4), cells)
    assert frame.origin_m.tolist() == np.array([0.1, -2, 3], np.float32).tolist()
    assert np.array_equal(frame.camera_to_world, POSE)


def test_a_bin_is_pairs_of_value_and_count():
    """Read back with numpy alone, as the page describes the file."""
    cells = np.zeros((60, 36, 60), np.uint8)
    cells[:, 0, :] = 2
    data = encode_bin(cells, np.zeros(3), POSE)
    assert np.frombuffer(data, "<f4", 19)[3:].tolist() == POSE.ravel().tolist()
    pairs = np.frombuffer(data, "<u4", offset=76).reshape(-1, 2)
    assert pairs[:, 1].sum() == 240 * 144 * 240
    assert pairs[0].tolist() == [2, 4 * 240]  # The floor: four of 144 layers, 240 cells along y.


def test_codes_lead_back_to_their_classes():
    assert CLASS_OF_CODE[CODE_OF_CLASS].tolist() == list(range(12))
    listed = (
        "0 1 2 3 4 11 5 6 7 8 8 10 10 10 11 11 9 8 11 11 11 11 11 11 11 11 11 10 10 11 8 10 11 9"
    )
    assert CLASS_OF_CODE.tolist() == [int(word) for word in f"{listed} 11 11 11".split()]


def _with(pairs):
    return np.zeros(19, "<f4").tobytes() + np.array(pairs, "<u4").tobytes()


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "not a valid SSCNet .bin: 0 bytes is not a possible file size"),
        (bytes(80), "not a valid SSCNet .bin: 80 bytes is not a possible file size"),
        (bytes(76), "not a valid SSCNet .bin: contains 0 voxels, expected 8,294,400"),
        (_with([[0, 7]]), "not a valid SSCNet .bin: contains 7 voxels, expected 8,294,400"),
        (_with([[0, 2**32 - 1]] * 9), "voxels, expected 8,294,400"),
        (_with([[37, 8_294_400]]), "contains the unknown class code 37"),
    ],
)
def test_broken_bins_are_refused(data, words, tmp_path):
    (tmp_path / "a.bin").write_bytes(data)
    with pytest.raises(DamagedFileError) as caught:
        read_bin(tmp_path / "a.bin")
    assert str(caught.value).endswith(words)


def test_a_missing_bin_is_named(tmp_path):
    with pytest.raises(InputError, match="none.bin: cannot be read"):
        read_bin(tmp_path / "none.bin")
