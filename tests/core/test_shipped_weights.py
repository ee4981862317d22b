"""Shipped networks are those that were shipped, and each has a card that says its origin."""

import shutil
from hashlib import sha256

import pytest

from world2minecraft.core import shipped_weights
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.shipped_weights import FOLDER, SUMS, checksums, read_weights, shipped

NETWORKS = sorted(path.name for path in FOLDER.iterdir() if path.suffix in (".onnx", ".npz"))


def test_all_networks_and_nothing_else_have_checksums():
    assert sorted(checksums()) == NETWORKS


@pytest.mark.parametrize("name", NETWORKS)
def test_a_network_is_what_was_shipped(name):
    data = read_weights(shipped(name))
    assert f"{sha256(data).hexdigest()}  {name}\n" in SUMS.read_text()


@pytest.mark.parametrize("name", NETWORKS)
def test_a_card_says_where_a_network_comes_from(name):
    card = (FOLDER / name).with_suffix(".md").read_text(encoding="utf-8")
    rows = {line.split("|")[1].strip() for line in card.splitlines() if line.startswith("| ")}
    assert rows & {"data", "generated data"} and {"training", "file", "licence"} <= rows
    assert "`python -m benchmarks.train_" in card or "`w2m train " in card


def test_a_changed_network_is_refused_and_a_copy_is_not(tmp_path, monkeypatch):
    name = "object_names.npz"
    copy = shutil.copy(shipped(name), tmp_path / name)
    copy.write_bytes(copy.read_bytes()[:-1] + b"x")
    assert read_weights(copy), "a network of one's own has no checksum"
    monkeypatch.setattr(shipped_weights, "FOLDER", tmp_path)
    with pytest.raises(DamagedFileError, match="differs from the network that was shipped"):
        read_weights(copy)
    other = shutil.copy(copy, tmp_path / "other.npz")
    with pytest.raises(DamagedFileError, match="copy your own network to another folder"):
        read_weights(other)


def test_missing_and_large_files_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_weights(tmp_path / "none.onnx")
    with pytest.raises(LimitError):
        read_weights(shipped("mono.onnx"), 1000)
