"""Pickles: what is written opens everywhere, what is read runs nothing."""

import io
import os
import pickle
import pickletools
import struct
from collections import OrderedDict

import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.formats.safe_pickle import dump_pickle, parse_pickle, read_pickle

VALUES = {
    "name": "scene0000_00/00012 é",
    "labels": np.arange(24, dtype=np.uint8).reshape(2, 3, 4),
    "pose": np.linspace(0, 1, 16, dtype=np.float32).reshape(4, 4),
    "points": np.linspace(-5, 5, 9).reshape(3, 3),
    "mask": np.array([[True, False]]),
    "count": -7,
    "large": 1 << 40,
    "share": 0.25,
    "yes": True,
    "none": None,
    "paths": ["a.jpg", "b.jpg"],
    "dim": [60, 60, 36],
    "empty": np.zeros((0, 3), np.int64),
}


def assert_same(found, expected):
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        if isinstance(value, np.ndarray):
            assert found[name].dtype == value.dtype, name
            assert found[name].shape == value.shape, name
        np.testing.assert_array_equal(found[name], value, err_msg=name)


def test_python_opens_what_is_written():
    assert_same(pickle.loads(dump_pickle(VALUES)), VALUES)


def test_written_arrays_may_be_written_to():
    labels = pickle.loads(dump_pickle(VALUES))["labels"]
    labels[labels == 0] = 12  # As EmbodiedOcc's loader does.
    assert labels.flags.c_contiguous


def test_only_names_of_numpy_1_are_written():
    operations = list(pickletools.genops(dump_pickle(VALUES)))
    names = {argument for operation, argument, _ in operations if operation.name == "GLOBAL"}
    assert names == {"numpy.core.multiarray _reconstruct", "numpy ndarray", "numpy dtype"}
    assert operations[0][1] == 3  # Protocol 3: Python 3.0 and later.


@pytest.mark.parametrize("protocol", range(6))
def test_pickles_of_every_protocol_are_read(protocol):
    values = VALUES | {"scalar": np.float32(2.5), "tuple": (1, 2), "bytes": b"\x00\xff"}
    found = parse_pickle(pickle.dumps(values, protocol))
    assert_same(found, values | {"tuple": [1, 2]})
    assert found["scalar"].dtype == np.float32


@pytest.mark.parametrize("protocol", range(6))
def test_pickles_of_numpy_1_are_read(protocol):
    data = pickle.dumps(VALUES, protocol)
    data = data.replace(b"\x8c\x16numpy._core.multi", b"\x8c\x15numpy.core.multi")
    data = data.replace(b"\x8c\x13numpy._core.numeric", b"\x8c\x12numpy.core.numeric")
    data = data.replace(b"cnumpy._core", b"cnumpy.core")
    assert b"_core" not in data
    assert_same(parse_pickle(data), VALUES)


def test_what_is_written_is_read():
    assert_same(parse_pickle(dump_pickle(VALUES)), VALUES)


def test_fortran_order_and_big_endian_are_kept():
    turned = {"turned": np.asfortranarray(np.arange(6).reshape(2, 3))}
    values = turned | {"big": np.arange(3, dtype=">i4")}
    assert_same(parse_pickle(pickle.dumps(values)), values)
    assert_same(pickle.loads(dump_pickle(turned)), turned)


def test_an_ordered_dict_and_shared_arrays_are_read():
    shared = np.arange(3)
    found = parse_pickle(pickle.dumps(OrderedDict(a=shared, b=shared)))
    np.testing.assert_array_equal(found["a"], found["b"])


class _Runs:
    def __init__(self, function, *arguments):
        self.call = function, arguments

    def __reduce__(self):
        return self.call


def _global(module, name, argument="touch here"):
    return f"c{module}\n{name}\n(S'{argument}'\ntR.".encode()


NESTED = b")" + b"\x85" * 150_000  # Tuples in tuples: a hash of the outer one overflows the stack.
HOSTILE = {
    "a deep key": b"\x80\x02}" + NESTED + b"K\x01s.",
    "a deep name": b"\x80\x04" + NESTED + b"\x8c\x01a\x93.",
    "a deep dtype": b"\x80\x02cnumpy\ndtype\n" + NESTED + b"\x85R.",
    "a shell": pickle.dumps({"x": _Runs(os.system, "touch hostile")}),
    "eval": pickle.dumps({"x": _Runs(eval, "1")}),
    "a shell, protocol 0": pickle.dumps({"x": _Runs(os.system, "touch hostile")}, 0),
    "getattr": _global("builtins", "getattr"),
    "numpy's own shell": _global("numpy.testing._private.utils", "runstring"),
    "numpy's load": _global("numpy", "load"),
    "a name below numpy": _global("numpy.core.multiarray", "os.system"),
    "objects": pickle.dumps({"x": np.array([object], dtype=object)}),
    "records": pickle.dumps({"x": np.zeros(2, [("a", "i4"), ("b", "f8")])}),
    "a class of its own": pickle.dumps({"x": io.BytesIO(b"x")}),
    "an old instance": b"(ios\nsystem\n(S'touch hostile'\no.",
    "a persistent name": b"Pevil\n.",
    "an extension": b"\x82\x01.",
    "no dict": pickle.dumps([1, 2]),
    "a key that is a number": pickle.dumps({1: 2}),
    "an array longer than its bytes": dump_pickle({"x": np.zeros(8, np.uint8)}).replace(
        b"J\x08\x00\x00\x00", struct.pack("<ci", b"J", 1 << 30)
    ),
    "cut short": dump_pickle(VALUES)[:-9],
    "nothing": b"",
    "text": b"hello world",
    "a memo beyond memory": b"\x80\x03}r\xff\xff\xff\x7fNt.",
    "an array of an array's state": b"\x80\x03cnumpy\nndarray\nN}b.",
    "lists in lists": pickle.dumps({"x": [[[[[1]]]]]}),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_and_broken_pickles_are_refused(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DamagedFileError):
        parse_pickle(HOSTILE[name], "x.pkl")
    assert not list(tmp_path.iterdir())


def test_a_refusal_names_the_file_and_what_it_wanted():
    with pytest.raises(DamagedFileError) as caught:
        parse_pickle(HOSTILE["eval"], "x.pkl")
    assert str(caught.value) == (
        "x.pkl: refers to builtins.eval, which is not allowed; the file was not read"
    )


def test_a_list_that_holds_itself_is_refused():
    looped: list = []
    looped.append(looped)
    with pytest.raises(DamagedFileError, match="contains an unsupported list"):
        parse_pickle(pickle.dumps({"x": looped}))


def test_a_program_of_many_steps_is_refused():
    with pytest.raises(DamagedFileError, match="operations"):
        parse_pickle(b"\x80\x03(" + b"N0" * 150_000 + b"t.")


def test_missing_and_large_files_are_named(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_pickle(tmp_path / "none.pkl")
    (tmp_path / "x.pkl").write_bytes(dump_pickle(VALUES))
    with pytest.raises(LimitError, match="the limit is 10"):
        read_pickle(tmp_path / "x.pkl", limit_bytes=10)


def test_values_of_other_kinds_are_not_written():
    with pytest.raises(TypeError, match="cannot pickle a set"):
        dump_pickle({"x": {1}})
    with pytest.raises(TypeError, match="cannot pickle an array of object"):
        dump_pickle({"x": np.array([None])})
