"""``w2m export``: weights of a run become a file that the predictor takes."""

import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("lightning")
pytest.importorskip("onnx")

from world2minecraft import cli
from world2minecraft.networks.checkpoints import write_weights
from world2minecraft.networks.config import DataSource, RunConfig
from world2minecraft.networks.training import build_network
from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor


@pytest.fixture
def run(tmp_path):
    config = RunConfig("monoscene", (DataSource(str(tmp_path)),), size="tiny", image=(64, 48))
    (tmp_path / "RUN").mkdir()
    write_weights(tmp_path / "RUN" / "weights.safetensors", build_network(config), config)
    return tmp_path / "RUN"


def test_a_run_becomes_a_file_that_predicts(run, capsys):
    out = run / "net.onnx"
    assert cli.run(["export", str(run), "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "monoscene-tiny" in said and f"--predictor mono:{out}" in said
    network = MonoPredictor(out).network
    assert network.facts.grid_shape == (30, 30, 18) and network.facts.image_size_px == (64, 48)
    pose = np.eye(4)
    found = network.probabilities(np.zeros((3, 48, 64), np.float32), np.eye(3), pose)
    np.testing.assert_allclose(found.sum(axis=-1), 1, atol=1e-4)


def test_compressed_weights_report_how_far_logits_move(run, capsys):
    out = run / "small.onnx"
    assert cli.run(["export", str(run), "--out", str(out), "--weights", "int8"]) == 0
    said = capsys.readouterr().out
    assert f"{out}: monoscene-tiny, {out.stat().st_size / 1e6:.1f} MB; " in said
    assert "int8 weights change a logit by " in said and f"w2m evaluate occupancy {out}" in said
    assert cli.run(["export", str(run), "--out", str(out), "--weights", "int4"]) == 2
    assert "no weight format is named 'int4'; did you mean 'int8'" in capsys.readouterr().err


def test_what_is_no_weights_is_refused(tmp_path, capsys):
    assert cli.run(["export", str(tmp_path), "--out", str(tmp_path / "n.onnx")]) == 3
    assert "weights.safetensors" in capsys.readouterr().err
