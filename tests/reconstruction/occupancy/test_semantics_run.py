"""A whole run with a segmenter: its votes name cells, its unknown labels are told once."""

import json
from dataclasses import replace

import numpy as np
import pytest
from tests.exact_room import BoxRoom
from tests.reconstruction.occupancy.tiny_network import write_network
from tests.reconstruction.occupancy.tiny_segmenters import write_segmenter

from world2minecraft.capture import write_plain
from world2minecraft.reconstruction.occupancy import OccupancyParameters
from world2minecraft.reconstruction.occupancy import semantic_fusion as kept
from world2minecraft.reconstruction.occupancy.hf_segmenter import HuggingFaceSemantics
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct

ROOM = BoxRoom()


@pytest.fixture
def capture(tmp_path, monkeypatch):
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "cache"))
    write_plain(tmp_path / "scan", ROOM.views(8), depth_unit="m")
    return tmp_path / "scan"


def test_a_run_with_a_segmenter(tmp_path, capture, monkeypatch):
    pytest.importorskip("torch")
    pytest.importorskip("transformers")
    folder = write_segmenter("segformer", tmp_path / "model")
    chosen = Parameters(occupy=OccupancyParameters(semantics=f"hf:{folder}"))
    scan = reconstruct(capture, tmp_path / "OUT", chosen)
    votes = np.load(tmp_path / "OUT" / "evidence.npz")["votes"].astype(float)
    voted = sorted(np.unique(np.nonzero(votes.reshape(-1, 12).sum(axis=0))[0]).tolist())
    assert voted and set(voted) <= {2, 3, 5, 6, 7}, "the classes that its five labels mean"
    assert (votes % 1 > 0.01).any(), "votes are soft"
    told = [note for note in scan.notes if "have no class" in note]
    assert len(told) == 1 and "1 of 7 labels of hf:model" in told[0] and "gizmo" in told[0]
    notes = json.loads((tmp_path / "OUT" / "scan.json").read_text())["notes"]
    assert told[0] in notes

    def never(self, colour, classes):
        raise AssertionError("it was asked again")

    monkeypatch.setattr(HuggingFaceSemantics, "predict", never)
    reconstruct(capture, tmp_path / "AGAIN", chosen)
    for name in ("evidence.npz", "room.npz", "objects.json"):
        again = (tmp_path / "AGAIN" / name).read_bytes()
        assert again == (tmp_path / "OUT" / name).read_bytes(), name
    assert kept.FOLDER in {path.name for path in (tmp_path / "cache").iterdir()}


def test_a_run_with_votes_of_a_monocular_network(tmp_path, capture):
    """They join by the option alone, and by fusing anew what a run without them left."""
    pytest.importorskip("onnx")
    plain = Parameters(occupy=OccupancyParameters(semantics="none"))
    reconstruct(capture, tmp_path / "OUT", plain)
    assert not np.load(tmp_path / "OUT" / "evidence.npz")["votes"].any()
    network = write_network(tmp_path / "n.onnx")
    joined = replace(plain, occupy=OccupancyParameters(mono_votes=True, network=str(network)))
    before = np.load(tmp_path / "OUT" / "evidence.npz")
    before = {name: before[name] for name in ("log_odds", "hits")}
    reconstruct(capture, tmp_path / "OUT", joined, start="fuse")
    after = np.load(tmp_path / "OUT" / "evidence.npz")
    assert after["votes"].any()
    for name, values in before.items():
        assert np.array_equal(values, after[name]), f"votes change {name}"
