"""Grids of other networks in each convention: the same labels come back, anything else is named."""

import io
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UnknownNameError
from world2minecraft.formats import predicted_grids
from world2minecraft.formats.predicted_grids import (
    CONVENTIONS,
    GridRules,
    grid_to_camera,
    interpret_grid,
    read_stored_grid,
)
from world2minecraft.formats.safe_pickle import dump_pickle
from world2minecraft.formats.sscnet import encode_bin

# As the reference describes the formats: which of our axes each axis of the array is.
AXES = {"w2m": (0, 1, 2), "monoscene": (0, 2, 1), "sscnet": (0, 2, 1), "embodiedocc": (0, 1, 2)}
ISO = {"nyu": (0, 2, 1), "occscannet": (1, 0, 2)}
POSE = np.array([[1, 0, 0, 2.0], [0, 0, 1, 1.0], [0, -1, 0, 1.5], [0, 0, 0, 1]])
ORIGIN = np.array([-1.5, 0.25, -0.08])


def truth(seed: int) -> np.ndarray:
    """Labels of a frame's box that no exchange of axes leaves as they are."""
    rng = np.random.default_rng(seed)
    labels = np.zeros((60, 60, 36), np.uint8)
    labels[:, :, 1] = 2
    labels[rng.integers(0, 60), :, 2:] = 3
    x, y = rng.integers(0, 50, 2)
    labels[x : x + 9, y : y + 5, 2:12] = rng.integers(5, 12)
    labels[:, 58:] = 255
    return labels


def saved(folder, labels, kind, *, key="labels", as_="npz", place=True):
    """Write an array as one of the supported files."""
    where = {"cam_pose": POSE.astype(np.float32), "voxel_origin": ORIGIN} if place else {}
    path = folder / f"frame.{as_}"
    values = labels.astype(kind)
    if as_ == "npy":
        np.save(path, values)
    elif as_ == "npz":
        np.savez(path, **{key: values}, **where)
    else:
        path.write_bytes(dump_pickle({key: values, **where}))
    return path


def read(path, is_frame=True, **rules):
    return interpret_grid(read_stored_grid(path), GridRules(**rules), is_frame=is_frame)


@settings(max_examples=12, deadline=None)
@given(
    st.integers(0, 1000),
    st.sampled_from(sorted(AXES)),
    st.sampled_from(["npy", "npz", "pkl"]),
    st.sampled_from([np.uint8, np.uint16, np.int64, np.float32]),
)
def test_labels_come_back_from_each_convention(tmp_path_factory, seed, convention, as_, kind):
    labels = truth(seed)
    stored = labels.transpose(AXES[convention])
    path = saved(tmp_path_factory.mktemp("grid"), stored, kind, as_=as_)
    found = read(path, convention=convention)
    assert np.array_equal(found.labels, labels) and found.shares is None
    assert found.voxel_m == pytest.approx(0.08)
    if as_ != "npy":
        expected = np.linalg.inv(POSE) @ np.block([[np.eye(3), ORIGIN[:, None]], [0, 0, 0, 1]])
        np.testing.assert_allclose(grid_to_camera(found), expected, atol=1e-6)
    hot = found.probabilities()
    assert np.array_equal(hot.argmax(axis=3)[labels < 255], labels[labels < 255])
    assert not hot[labels == 255].any()


@pytest.mark.parametrize(("data", "order"), ISO.items())
def test_iso_has_the_axes_of_the_data_it_was_trained_on(tmp_path, data, order):
    path = saved(tmp_path, truth(1).transpose(order), np.uint8, key="y_pred")
    found = read(path, convention="iso")
    assert np.array_equal(found.labels, truth(1)), data


@pytest.mark.parametrize(("first", "kind"), [(True, "probabilities"), (False, "logits")])
@pytest.mark.parametrize("classes", ["nyu12", "embodied"])
def test_scores_come_back_as_probabilities(tmp_path, first, kind, classes):
    labels = truth(2)
    ids = np.where(labels == 0, 12, np.where(labels == 255, 0, labels))
    ids = ids if classes == "embodied" else np.where(labels == 255, 0, labels)
    channels = np.eye(13 if classes == "embodied" else 12)[ids]
    scores = channels * 6.0 if kind == "logits" else 0.8 * channels + 0.2 / channels.shape[-1]
    stored = np.moveaxis(scores, 3, 0) if first else scores
    path = saved(tmp_path, stored[None] if first else stored, np.float32, key="probabilities")
    found = read(path, convention="embodiedocc", scores=kind)
    expected = labels if classes == "embodied" else np.where(labels == 255, 0, labels)
    assert np.array_equal(found.labels, expected)
    assert found.shares is not None
    sums = found.shares.astype(np.float64).sum(axis=3)
    np.testing.assert_allclose(sums[expected < 255], 1, atol=5e-3)
    assert not sums[expected == 255].any()


def test_a_bin_of_sscnet_states_all(tmp_path):
    labels = truth(3)
    path = tmp_path / "NYU0001_0000.bin"
    path.write_bytes(encode_bin(labels.transpose(0, 2, 1), ORIGIN, POSE))
    found = read(path)
    assert np.array_equal(found.labels, labels)
    assert (found.convention, found.axes) == ("sscnet", "xzy")
    np.testing.assert_allclose(found.origin_m, ORIGIN, atol=1e-6)


@pytest.mark.parametrize(
    ("key", "order", "is_frame", "convention"),
    [
        ("y_pred", (0, 2, 1), True, "monoscene"),
        ("target_1_4", (1, 0, 2), True, "iso"),
        ("labels", (0, 1, 2), False, "w2m"),
    ],
)
def test_a_convention_is_found_where_it_is_certain(tmp_path, key, order, is_frame, convention):
    path = saved(tmp_path, truth(4).transpose(order), np.uint8, key=key, as_="pkl")
    found = read(path, is_frame=is_frame)
    assert found.convention == convention and np.array_equal(found.labels, truth(4))


def test_embodied_ids_are_found_by_their_12(tmp_path):
    labels = truth(5)
    ids = np.where(labels == 0, 12, np.where(labels == 255, 0, labels))
    found = read(saved(tmp_path, ids, np.uint8))
    assert found.convention == "embodiedocc" and np.array_equal(found.labels, labels)


def test_the_programs_own_files_state_their_axes(tmp_path):
    np.savez(tmp_path / "a.npz", labels=truth(6).transpose(0, 2, 1), axes=np.array("xzy"),
             origin_m=ORIGIN, camera_to_world=POSE, voxel_m=np.array(0.08))  # fmt: skip
    found = read(tmp_path / "a.npz")
    assert (found.convention, found.axes) == ("w2m", "xzy")
    assert np.array_equal(found.labels, truth(6))


def refused(path, kind=DamagedFileError, is_frame=True, **rules):
    with pytest.raises(kind) as caught:
        read(path, is_frame=is_frame, **rules)
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 3
    return str(caught.value).removeprefix(f"{path}: ")


def test_what_the_shape_cannot_tell_is_asked_for(tmp_path):
    path = saved(tmp_path, truth(7), np.uint8)
    assert refused(path, InputError) == (
        "has 60x60x36 cells, which may lie as x, y, z (EmbodiedOcc) or as y, x, z (ISO); set the "
        "convention to embodiedocc or iso (--convention)"
    )


@pytest.mark.parametrize(
    ("order", "convention", "message"),
    [
        ((0, 1, 2), "monoscene", "has 60x60x36 cells, but monoscene implies 60x36x60 as x, z, y; "
         "--convention iso or embodiedocc fits"),
        ((0, 2, 1), "embodiedocc", "has 60x36x60 cells, but embodiedocc implies 60x60x36 as x, y, "
         "z; --convention monoscene or iso or sscnet fits"),
    ],
)  # fmt: skip
def test_a_shape_that_contradicts_the_convention_is_named(tmp_path, order, convention, message):
    path = saved(tmp_path, truth(8).transpose(order), np.uint8)
    assert refused(path, convention=convention) == message


def test_a_shape_of_no_convention_is_named(tmp_path):
    path = saved(tmp_path, np.zeros((32, 32, 8)), np.uint8)
    assert refused(path, convention="iso") == (
        "has 32x32x8 cells, but iso implies 60x60x36 as y, x, z; no convention has this shape"
    )


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.full((60, 60, 36), np.nan, np.float32), "contains NaN or infinity, expected class ids"),
        (np.full((60, 60, 36), 0.5), "contains fractions, expected class ids; scores need one more "
         "axis, with a channel for each class"),
        (np.full((60, 60, 36), 77), "contains the class id 77, which nyu12 does not have; set "
         "classes (--classes) to nyu12, embodied, occscannet or a YAML file of ids and names"),
        (np.zeros((60, 60, 36), bool), "must contain class ids or scores, got values of type bool"),
        (np.zeros((60, 60, 36), "c8"), "must contain class ids or scores, got values of type "
         "complex64"),
        (np.zeros((12, 60, 60, 36), int), "must contain scores as floats, got int64"),
        (np.zeros((20, 60, 60, 36), np.float32), "has 20 score channels, but nyu12 has 12 classes"),
        (np.ones((12, 60, 60, 36), np.float32), "contains scores that do not add up to 1 in each "
         "cell; if they are logits, add --set predictions.scores=logits"),
        (np.full((12, 60, 60, 36), np.inf, "f4"), "contains NaN or infinity, expected scores"),
        (np.zeros((60, 60)), "must contain a grid with three axes, or four with scores, got (60, "
         "60)"),
        (np.zeros((60, 0, 36)), "contains an empty grid of shape (60, 0, 36)"),
    ],
)  # fmt: skip
def test_wrong_values_are_named(tmp_path, values, message):
    np.save(tmp_path / "a.npy", values)
    assert refused(tmp_path / "a.npy", convention="embodiedocc") == message


class Code:
    """A pickle of this calls a function when Python's unpickler reads it."""

    def __reduce__(self):
        return (print, ("it ran",))


def test_hostile_files_run_nothing_and_are_refused(tmp_path, capsys):
    evil = tmp_path / "a.pkl"
    evil.write_bytes(pickle.dumps({"labels": Code()}))
    assert "builtins.print, which is not allowed" in refused(evil)
    np.save(tmp_path / "b.npy", np.array([Code()], object), allow_pickle=True)
    refused(tmp_path / "b.npy")
    np.savez(tmp_path / "c.npz", labels=np.array([Code()], object))
    refused(tmp_path / "c.npz")
    for name in ("d.npy", "d.npz", "d.pkl", "d.bin"):
        (tmp_path / name).write_bytes(b"\x93NUMPY\x01\x00 not at all")
        refused(tmp_path / name)
    assert "it ran" not in capsys.readouterr().out


def test_huge_shapes_are_refused_before_memory_is_taken(tmp_path, monkeypatch):
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        head, {"descr": "|u1", "fortran_order": False, "shape": (1 << 20, 1 << 20, 4)}
    )
    (tmp_path / "a.npy").write_bytes(head.getvalue() + bytes(64))
    assert "contains less data" in refused(tmp_path / "a.npy")
    np.savez_compressed(tmp_path / "b.npz", labels=np.zeros((60, 60, 36)))
    monkeypatch.setattr(predicted_grids, "MAX_BYTES", 1 << 19)
    assert "bytes; the limit is 524,288" in refused(tmp_path / "b.npz", LimitError)
    monkeypatch.undo()
    np.save(tmp_path / "c.npy", np.zeros((300, 300, 200), np.uint8))
    assert (
        refused(tmp_path / "c.npy", LimitError) == "has 18,000,000 cells; the limit is 16,000,000"
    )


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (
            {"cam_pose": np.diag([1, 1, -1, 1.0])},
            "cam_pose is not a rotation and a translation: it is mirrored (determinant -1.000); "
            "check for an axis flipped on export",
        ),
        ({"cam_pose": np.eye(3)}, "cam_pose must have shape 4x4, got (3, 3)"),
        (
            {"voxel_origin": np.full(3, 1e30)},
            "voxel_origin is up to 1e+30 m, the limit is 2.1e+07 m; check the unit",
        ),
        ({"voxel_m": np.array(7.0)}, "voxel_m must be 0.005 to 1 m, got 7"),
    ],
)
def test_a_wrong_place_is_named(tmp_path, more, message):
    np.savez(tmp_path / "a.npz", labels=truth(9), **more)
    assert refused(tmp_path / "a.npz", convention="embodiedocc") == message


def test_unknown_names_suggest_the_closest(tmp_path):
    with pytest.raises(UnknownNameError, match="did you mean 'monoscene'"):
        GridRules("monoscen")
    with pytest.raises(UnknownNameError, match="no kind of scores is named 'logit'"):
        GridRules(scores="logit")
    assert set(CONVENTIONS) == {*AXES, "iso"}
    (tmp_path / "a.txt").write_text("0")
    assert "is not a grid; expected a file with .npy" in refused(tmp_path / "a.txt", InputError)
