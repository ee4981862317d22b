"""Files: whole or not at all, the same bytes for the same values, and hostile ones refused."""

import io
import os
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from world2minecraft.core import files
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, OutputError

arrays = hnp.arrays(
    st.sampled_from([np.uint8, np.int32, np.float16, np.float64, np.bool_]),
    hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
)


def npy(array, allow_pickle=False):
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, array, allow_pickle=allow_pickle)
    return buffer.getvalue()


def npy_that_says(shape, descr="|u1", data=b""):
    """A .npy whose header speaks of another shape than the data that follow."""
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


def npy_with_header(header):
    """A .npy whose header, which numpy parses as Python code, is this text."""
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header


def pack(path, members, compression=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return path


# Writing.


def test_a_file_is_written_with_its_folders(tmp_path):
    files.write_bytes(tmp_path / "a" / "b" / "c.bin", b"x")
    assert (tmp_path / "a" / "b" / "c.bin").read_bytes() == b"x"


def test_a_write_that_is_stopped_leaves_no_litter(tmp_path, monkeypatch):
    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", stopped)
    with pytest.raises(KeyboardInterrupt):
        files.write_bytes(tmp_path / "room.npz", b"new")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("step", ["replace", "fsync"])
def test_a_write_that_fails_leaves_the_old_file_and_no_litter(tmp_path, monkeypatch, step):
    target = tmp_path / "room.npz"
    target.write_bytes(b"old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, step, full)
    with pytest.raises(OutputError, match=r"room\.npz: cannot be written: No space left on device"):
        files.write_bytes(target, b"new")
    assert target.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["room.npz"]


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "out").write_text("a file")
    with pytest.raises(OutputError, match="cannot be written"):
        files.write_text(tmp_path / "out" / "room.json", "x")


def test_json_is_sorted_and_refuses_what_json_has_no_word_for(tmp_path):
    files.write_json(tmp_path / "a.json", {"b": 1, "a": [1.5, None]})
    files.write_json(tmp_path / "b.json", {"a": [1.5, None], "b": 1})
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert files.read_json(tmp_path / "a.json") == {"a": [1.5, None], "b": 1}
    with pytest.raises(ValueError, match="Out of range float"):
        files.write_json(tmp_path / "c.json", {"a": float("nan")})
    assert not (tmp_path / "c.json").exists()


@given(st.dictionaries(st.sampled_from("abc"), arrays, min_size=1))
def test_npz_round_trip_is_independent_of_array_order(tmp_path_factory, values):
    folder = tmp_path_factory.mktemp("npz")
    files.write_npz(folder / "a.npz", values)
    files.write_npz(folder / "b.npz", dict(reversed(values.items())))
    assert (folder / "a.npz").read_bytes() == (folder / "b.npz").read_bytes()
    back = files.read_npz(folder / "a.npz", tuple(values))
    assert list(back) == list(values)
    for name, value in values.items():
        assert back[name].dtype == value.dtype
        np.testing.assert_array_equal(back[name], value)


def test_numpy_reads_what_we_write(tmp_path):
    files.write_npz(tmp_path / "a.npz", {"x": np.arange(3)})
    with np.load(tmp_path / "a.npz") as archive:
        assert archive["x"].tolist() == [0, 1, 2]


def test_an_object_array_is_not_written(tmp_path):
    with pytest.raises(ValueError, match="Object arrays"):
        files.write_npz(tmp_path / "a.npz", {"x": np.array([{}], object)})
    assert not (tmp_path / "a.npz").exists()


# Reading what was not written here.


def test_a_missing_file_is_named(tmp_path):
    for read in (files.read_json, lambda path: files.read_npz(path, ("x",))):
        with pytest.raises(InputError, match=r"gone: (not found|cannot be read)"):
            read(tmp_path / "gone")


def test_a_file_over_its_limit_is_not_read(tmp_path):
    (tmp_path / "a.json").write_text("[" + "1," * 50 + "1]")
    with pytest.raises(LimitError, match=r"has 103 bytes; the limit is 10"):
        files.read_json(tmp_path / "a.json", limit_bytes=10)


NO_JSON = {"nothing": "", "cut short": "{", "a comma too many": "[1,]", "deep": "[" * 100_000}


@pytest.mark.parametrize("text", NO_JSON.values(), ids=NO_JSON)
def test_what_is_no_json_is_damaged(tmp_path, text):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(DamagedFileError, match="is not JSON"):
        files.read_json(tmp_path / "a.json")


def test_bytes_that_are_no_text_are_no_json(tmp_path):
    (tmp_path / "a.json").write_bytes(b"\xff\xfe\xff")
    with pytest.raises(DamagedFileError, match="is not JSON"):
        files.read_json(tmp_path / "a.json")


def test_a_missing_array_is_named_with_those_that_are_there(tmp_path):
    files.write_npz(tmp_path / "a.npz", {"labels": np.zeros(1), "colour": np.zeros(1)})
    with pytest.raises(
        DamagedFileError, match="does not contain the array 'instance'; available: colour, labels"
    ):
        files.read_npz(tmp_path / "a.npz", ("instance",))


HOSTILE = {
    "an object array": (npy(np.array([{}], object), allow_pickle=True), DamagedFileError),
    "more than it holds": (npy_that_says((10**15,)), DamagedFileError),
    "a size past 64 bits": (npy_that_says((2**40, 2**40, 2**40)), DamagedFileError),
    "a negative size": (npy_that_says((-5, 3), data=b"abc"), DamagedFileError),
    "data cut short": (npy(np.zeros(1000))[:500], DamagedFileError),
    "a header cut short": (npy(np.zeros(4))[:9], DamagedFileError),
    "no magic": (b"PK nonsense", DamagedFileError),
    "an empty member": (b"", DamagedFileError),
    "a header that is code": (npy_that_says("__import__('os').getcwd()"), DamagedFileError),
    "a header that ends in a bracket": (npy_with_header(b"{'descr': ("), DamagedFileError),
    "a header nested deeply": (npy_with_header(b"-" * 9000), DamagedFileError),
    "a type of no length": (
        npy_with_header(b"{'descr': (), 'fortran_order': False, 'shape': (3,)}"),
        DamagedFileError,
    ),
}


@pytest.mark.parametrize(("data", "error"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_array_is_refused(tmp_path, data, error):
    path = pack(tmp_path / "a.npz", {"x.npy": data})
    with pytest.raises(error, match=r"a\.npz: "):
        files.read_npz(path, ("x",))


def test_a_zip_bomb_is_refused_by_its_declared_size(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "MAX_ARRAY_BYTES", 1 << 20)
    path = pack(tmp_path / "a.npz", {"x.npy": npy(np.zeros(1 << 20, np.uint8))})
    assert path.stat().st_size < 5000
    with pytest.raises(
        LimitError, match=r"array 'x' has 1,048,\d\d\d bytes, which exceeds the limit"
    ):
        files.read_npz(path, ("x",))


def test_a_zip_that_lies_about_its_size_is_refused(tmp_path):
    """The member's header says 200 bytes; a megabyte would follow."""
    path = pack(tmp_path / "a.npz", {"x.npy": npy(np.zeros(1 << 20, np.uint8))})
    data = bytearray(path.read_bytes())
    real = struct.pack("<I", len(npy(np.zeros(1 << 20, np.uint8))))
    while (at := data.find(real)) >= 0:
        data[at : at + 4] = struct.pack("<I", 200)
    path.write_bytes(data)
    with pytest.raises(DamagedFileError):
        files.read_npz(path, ("x",))


@pytest.mark.parametrize("keep", [0, 10, 60, 0.5, 0.9])
def test_a_truncated_archive_is_damaged(tmp_path, keep):
    path = tmp_path / "a.npz"
    files.write_npz(path, {"x": np.arange(5000)})
    data = path.read_bytes()
    path.write_bytes(data[: int(keep * len(data)) if isinstance(keep, float) else keep])
    with pytest.raises(DamagedFileError, match="is not a readable"):
        files.read_npz(path, ("x",))


@given(st.data())
def test_a_damaged_byte_is_refused_or_harmless(tmp_path_factory, data):
    """Any one byte may be wrong: the reader says so with its own error, or reads arrays."""
    path = tmp_path_factory.mktemp("npz") / "a.npz"
    files.write_npz(path, {"x": np.arange(40)})
    raw = bytearray(path.read_bytes())
    raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(raw)
    try:
        assert isinstance(files.read_npz(path, ("x",))["x"], np.ndarray)
    except InputError as error:
        assert str(path) in str(error)


def test_an_encrypted_member_is_refused(tmp_path):
    path = pack(tmp_path / "a.npz", {"x.npy": npy(np.zeros(3))}, zipfile.ZIP_STORED)
    data = bytearray(path.read_bytes())
    central = data.find(b"PK\x01\x02")
    data[central + 8] |= 1
    data[6] |= 1
    path.write_bytes(data)
    with pytest.raises(DamagedFileError):
        files.read_npz(path, ("x",))


def test_yaml_aliases_are_refused():
    assert files.load_plain_yaml("a: [1, x]\nb: {c: 0.5}\n") == {"a": [1, "x"], "b": {"c": 0.5}}
    with pytest.raises(ValueError, match=r"^aliases \(\*name\) are not supported$"):
        files.load_plain_yaml("a: &a [x, x]\nb: [*a, *a]\n")


@pytest.mark.parametrize("text", ["a: [1\n", "[" * 5000, "a: !!python/object:os.system x"])
def test_what_is_no_yaml_is_told_in_one_line(text):
    with pytest.raises(ValueError, match=r"\A[^\n]+\Z"):
        files.load_plain_yaml(text)


def test_json_rows_have_line_numbers_and_errors_name_them():
    source = Path("rows.jsonl")
    assert files.parse_json_lines('{"a": 1}\n\n{"b": 2}\n', source) == [
        (1, {"a": 1}),
        (3, {"b": 2}),
    ]
    assert files.parse_json_lines('{"a": "one\u2028line"}\r\n', source) == [
        (1, {"a": "one\u2028line"})
    ]
    for text, told in (
        ("{}\n{", "line 2 is not valid JSON"),
        ("[1]", "line 1 is not a JSON object"),
    ):
        with pytest.raises(DamagedFileError) as caught:
            files.parse_json_lines(text, source)
        assert str(caught.value) == f"rows.jsonl: {told}"
