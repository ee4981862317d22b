"""Valid files with some numbers replaced by extremes, and a limit on the readers' memory."""

import re
import struct
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from world2minecraft.core.files import npz_array_names, read_npz, write_npz
from world2minecraft.formats.safe_pickle import dump_pickle, read_pickle

NUMBER = re.compile(r"(?<![\w.+-])-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?![\w.])")
EXTREMES = (
    "0", "-0.0", "-1", "1e-320", "1e-9", "1e6", "-1e6", "5400000", "1e18", "1e30", "-1e30",
    "1e300", "-1.7e308", "65536", "2147483647", "2147483648", "-2147483648", "-2147483649",
    "9223372036854775808", "1" + "0" * 400, "NaN", "Infinity", "-Infinity",
)  # fmt: skip
KINDS = ("<f4", "<f8", "<i4", "<i8", "<u2", ">f4", ">i4", "<u1")
HEAD_BYTES = 256
READ_BYTES = 3 << 30  # A reader of files of some kilobytes may reserve no more address space.
Picks = list[tuple[float, str, bool]]

PICKS = st.lists(
    st.tuples(st.floats(0, 1, exclude_max=True), st.sampled_from(EXTREMES), st.booleans()),
    min_size=1,
    max_size=3,
)


def replace_numbers(text: str, picks: Picks) -> str:
    """Replace numbers of a text, each picked by its share of the way through, by other texts."""
    found = list(NUMBER.finditer(text))
    chosen = {int(share * len(found)): new for share, new, _ in picks} if found else {}
    parts, at = [], 0
    for index in sorted(chosen):
        parts += [text[at : found[index].start()], chosen[index]]
        at = found[index].end()
    return "".join([*parts, text[at:]])


def replace_values(path: Path, picks: Picks) -> None:
    """Replace a value of some arrays of an npz, or all of them, by the nearest of their type."""
    arrays = read_npz(path, npz_array_names(path))
    change_values(arrays, picks)
    write_npz(path, arrays)


def replace_pickled(path: Path, picks: Picks) -> None:
    """Replace values of the arrays of a pickled dict like those of an npz."""
    stored = read_pickle(path)
    change_values(stored, picks)
    path.write_bytes(dump_pickle(stored))


def change_values(stored: dict[str, Any], picks: Picks) -> None:
    names = sorted(stored)
    for share, new, whole in picks:
        name = names[int(share * len(names))]
        values = np.asarray(stored[name])
        if values.dtype.kind not in "iuf" or not values.size:
            continue
        changed = values.copy().reshape(-1)
        where = slice(None) if whole else int(share * 997) % len(changed)
        changed[where] = nearest(new, values.dtype)
        stored[name] = changed.reshape(values.shape)


def replace_bytes(path: Path, picks: Picks) -> None:
    """Replace some bytes of a binary file, in its head or anywhere, by numbers of any type."""
    data = bytearray(path.read_bytes())
    for share, new, in_head in picks:
        kind = KINDS[int(share * 9973) % len(KINDS)]
        piece = np.array(nearest(new, np.dtype(kind)), kind).tobytes()
        span = min(HEAD_BYTES, len(data)) if in_head else len(data)
        at = max(min(int(share * span), len(data) - len(piece)), 0)
        data[at : at + len(piece)] = piece
    path.write_bytes(data)


def replace_e57(path: Path, picks: Picks) -> None:
    """Replace numbers of the XML of an E57 file."""
    change_xml(path, lambda xml: replace_numbers(xml, picks))


def change_xml(path: Path, change: Callable[[str], str]) -> None:
    """Change the XML of an E57 file, whose pages get new checksums."""
    data = path.read_bytes()
    _, start, size, page = struct.unpack("<4Q", data[16:48])
    held = page - 4
    body = b"".join(data[at : at + held] for at in range(0, len(data), page))
    first = start // page * held + start % page
    xml = change(body[first : first + size].decode()).encode()
    pages = -(-(first + len(xml)) // held)
    head = data[:16] + struct.pack("<4Q", pages * page, start, len(xml), page)
    body = (head + body[48:first] + xml).ljust(pages * held, b"\0")
    parts = [body[at : at + held] for at in range(0, len(body), held)]
    path.write_bytes(b"".join(part + struct.pack(">I", crc32c(part)) for part in parts))


def crc32c(data: bytes) -> int:
    """Return the checksum of Castagnoli, which E57 uses."""
    rest = 0xFFFFFFFF
    for byte in data:
        rest ^= byte
        for _ in range(8):
            rest = rest >> 1 ^ (0x82F63B78 if rest & 1 else 0)
    return rest ^ 0xFFFFFFFF


def nearest(text: str, dtype: np.dtype) -> float | int:
    """Return the number of a type that is nearest to a text; 0 for NaN in whole numbers."""
    number = float(text[:300])
    if dtype.kind == "f":
        limits = np.finfo(dtype)
        held = np.isfinite(number)
        return min(max(number, float(limits.min)), float(limits.max)) if held else number
    limits = np.iinfo(dtype)
    if np.isnan(number):
        return 0
    return int(limits.max) if number >= limits.max else int(max(number, limits.min))


def replace_in(path: Path, picks: Picks) -> None:
    """Replace numbers of a file: values of an npz, numbers of a text, bytes of any other."""
    others = {".npz": replace_values, ".e57": replace_e57, ".pkl": replace_pickled}
    special = others.get(path.suffix)
    if special is not None:
        special(path, picks)
        return
    try:
        text = path.read_text()
    except UnicodeDecodeError:
        replace_bytes(path, picks)
    else:
        path.write_text(replace_numbers(text, picks))


@contextmanager
def limited_memory() -> Iterator[None]:
    """Let the block reserve at most ``READ_BYTES`` more of address space, where Linux says so."""
    if sys.platform != "linux":
        yield
        return
    import resource

    pages = int(Path("/proc/self/statm").read_text().split()[0])
    before = resource.getrlimit(resource.RLIMIT_AS)
    limit = pages * resource.getpagesize() + READ_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (limit, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)
