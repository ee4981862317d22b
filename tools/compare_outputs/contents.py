"""Whether two files say the same, and where they differ.

Equal bytes are always the same. Of others, pictures, scenes and documents are decoded and compared
as data, after what ``declared`` says; grids, worlds and the game's other files must be equal byte
for byte, and are decoded only to tell where they differ.
"""

import base64
import contextlib
import gzip
import html.parser
import io
import json
import re
import struct
import tarfile
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import onnx
import OpenEXR
import yaml
from PIL import Image, ImageSequence
from pyarrow import parquet

from compare_outputs import declared
from compare_outputs.nbt import read_nbt

MOST_TOLD = 12  # Differences of one file; more tell nothing.
Image.MAX_IMAGE_PIXELS = None


class File(NamedTuple):
    """A file of one side: its path within the step, its bytes, and the texts to replace in it."""

    path: str
    data: bytes
    places: Mapping[str, str]
    is_base: bool

    def text(self, prints: bool = False) -> str:
        """Return it as text, after all that is declared."""
        return normal_text(self.data.decode("utf-8", "replace"), self, prints)


def differences(base: File, tree: File, prints: bool = False) -> list[str]:
    """Return what differs, in a line each; nothing where both say the same."""
    not_compared = (*declared.VARYING_FILES, *declared.REDRAWN)
    if base.data == tree.data or _matches(not_compared, base.path):
        return []
    suffix = Path(base.path).suffix.lower()
    compare = _BY_NAME.get(Path(base.path).name) or _BY_SUFFIX.get(suffix, _bytes)
    if prints:
        compare = _prints
    try:
        found = list(_first(compare(base, tree)))
    except Exception as error:  # Whatever a broken file does to a reader, the file differs.
        return [f"differs, and cannot be decoded: {type(error).__name__}: {error}"]
    return found


def _first(found: Iterator[str]) -> Iterator[str]:
    for number, line in enumerate(found):
        if number == MOST_TOLD:
            yield "..."
            return
        yield line


def _matches(patterns: tuple[str, ...], path: str) -> bool:
    return any(re.fullmatch(pattern, path) for pattern in patterns)


def normal_text(text: str, side: File, prints: bool = False) -> str:
    """Return a text with its places, versions, dates and declared changes made alike."""
    for place, name in side.places.items():
        text = text.replace(place, name)
    if prints:
        kept = [one for one in text.splitlines() if not declared.VARYING_LINES.search(one)]
        text = "\n".join(kept) + "\n"
    for pattern, stand_in in (*declared.VARYING_TEXTS, *(declared.VARYING_PRINTS * prints)):
        text = pattern.sub(stand_in, text)
    if side.is_base:
        for old, new in declared.TEXTS.items():
            text = text.replace(old, new)
    return text


def _normal(value: Any, side: File, varying: frozenset[str]) -> Any:
    """Return a value of JSON with keys and texts as declared; what varies is None."""
    if isinstance(value, dict):
        return {
            _key(key, side): None
            if key in varying or "*" in varying
            else _normal(one, side, varying)
            for key, one in value.items()
        }
    if isinstance(value, (list, tuple)):
        return [_normal(one, side, varying) for one in value]
    return normal_text(value, side) if isinstance(value, str) else value


def _key(key: Any, side: File) -> Any:
    if not isinstance(key, str):
        return key
    return normal_text(declared.KEYS.get(key, key) if side.is_base else key, side)


def _varying(path: str) -> frozenset[str]:
    found = [keys for pattern, keys in declared.VARYING_KEYS if re.fullmatch(pattern, path)]
    return frozenset().union(*found)


# ---- documents


def _trees(base: Any, tree: Any, at: str = "") -> Iterator[str]:
    """Tell where two values of JSON differ."""
    where = at or "the whole"
    if isinstance(base, dict) and isinstance(tree, dict):
        for key in base.keys() | tree.keys():
            if key not in tree:
                yield f"{at}/{key}: missing"
            elif key not in base:
                yield f"{at}/{key}: additional"
            else:
                yield from _trees(base[key], tree[key], f"{at}/{key}")
    elif isinstance(base, list) and isinstance(tree, list):
        if len(base) != len(tree):
            yield f"{where}: {len(base)} entries, now {len(tree)}"
        for number, (one, other) in enumerate(zip(base, tree, strict=False)):
            yield from _trees(one, other, f"{at}/{number}")
    elif type(base) is not type(tree) or (base != tree and not _both_nan(base, tree)):
        yield f"{where}: {_short(base)}, now {_short(tree)}"


def _both_nan(base: Any, tree: Any) -> bool:
    return isinstance(base, float) and base != base and tree != tree


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 90 else text[:87] + "..."


def _documents(parse: Callable[[str], Any]) -> Callable[[File, File], Iterator[str]]:
    def compare(base: File, tree: File) -> Iterator[str]:
        varying = _varying(base.path)
        one, other = (
            _normal(parse(side.data.decode("utf-8")), side, varying) for side in (base, tree)
        )
        yield from _trees(one, other)

    return compare


def _lines_of_json(text: str) -> list[Any]:
    return [json.loads(line) for line in text.splitlines() if line.strip()]


def _texts(base: File, tree: File) -> Iterator[str]:
    yield from _words(base.text(), tree.text())


def _prints(base: File, tree: File) -> Iterator[str]:
    if all(side.data[:1] in (b"{", b"[") for side in (base, tree)):
        with contextlib.suppress(ValueError):
            yield from _documents(json.loads)(base, tree)
            return
    yield from _words(base.text(prints=True), tree.text(prints=True))


def _words(base: str, tree: str) -> Iterator[str]:
    """Tell where two texts differ, whatever their line breaks and spaces."""
    yield from _rows(base.split(), tree.split())


def _rows(one: list[str], other: list[str]) -> Iterator[str]:
    if one == other:
        return
    start = next(
        (n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b),
        min(len(one), len(other)),
    )
    one, other = one[max(start - 4, 0) :], other[max(start - 4, 0) :]
    for verb, a, b, c, d in SequenceMatcher(None, one[:2000], other[:2000], False).get_opcodes():
        if verb != "equal":
            before = " ".join(one[max(a - 4, 0) : a])
            was, now = _short(" ".join(one[a:b])), _short(" ".join(other[c:d]))
            yield f"after {before!r}: {was}, now {now}"


class _Page(html.parser.HTMLParser):
    """A page as a row of tags and texts, pictures by their pixels."""

    def __init__(self) -> None:
        super().__init__()
        self.row: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = sorted((key, _pixels_of_link(value or "")) for key, value in attrs)
        self.row.append(f"<{tag} {' '.join(f'{key}={value}' for key, value in told)}>")

    def handle_endtag(self, tag: str) -> None:
        self.row.append(f"</{tag}>")

    def handle_data(self, data: str) -> None:
        self.row += data.split()


def _pixels_of_link(value: str) -> str:
    found = re.fullmatch(r"data:image/(\w+);base64,(.*)", value, re.DOTALL)
    if not found or found[1] == "svg":
        return value
    picture = _pixels(base64.b64decode(found[2]))
    return f"{found[1]}:{picture.shape}:{zlib.crc32(picture.tobytes()):08x}"


def _pages(base: File, tree: File) -> Iterator[str]:
    rows = []
    for side in (base, tree):
        page = _Page()
        page.feed(side.text())
        rows.append(page.row)
    yield from _rows(*rows)


# ---- pictures


def _pixels(data: bytes) -> np.ndarray:
    with Image.open(io.BytesIO(data)) as picture:
        frames = [np.asarray(frame.copy()) for frame in ImageSequence.Iterator(picture)]
    return np.stack(frames) if len({one.shape for one in frames}) == 1 else frames[0]


def _pictures(base: File, tree: File) -> Iterator[str]:
    yield from _arrays("pixels", _pixels(base.data), _pixels(tree.data))


def _channels(data: bytes) -> dict[str, np.ndarray]:
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        file.write(data)
        file.flush()
        with OpenEXR.File(file.name, separate_channels=True) as picture:
            return {name: np.array(one.pixels) for name, one in picture.channels().items()}


def _exrs(base: File, tree: File) -> Iterator[str]:
    yield from _named_arrays(_channels(base.data), _channels(tree.data))


# ---- arrays


def _arrays(name: str, base: np.ndarray, tree: np.ndarray) -> Iterator[str]:
    if base.dtype != tree.dtype or base.shape != tree.shape:
        yield f"{name}: {base.dtype}{base.shape}, now {tree.dtype}{tree.shape}"
    elif base.tobytes() != tree.tobytes():
        differs = np.asarray(base != tree)
        told = f"{name}: {int(differs.sum()):,} of {differs.size:,} values differ"
        if base.dtype.kind in "uif" and differs.any():
            apart = np.abs(base.astype(np.float64) - tree.astype(np.float64))
            told += f", by up to {float(np.nanmax(apart)):g}"
        yield told


def _named_arrays(base: Mapping[str, np.ndarray], tree: Mapping[str, np.ndarray]) -> Iterator[str]:
    base = {declared.KEYS.get(name, name): one for name, one in base.items()}
    for name in sorted(base.keys() | tree.keys()):
        if name not in tree:
            yield f"{name}: missing"
        elif name not in base:
            yield f"{name}: additional"
        else:
            yield from _arrays(name, base[name], tree[name])


def _npz(data: bytes) -> dict[str, np.ndarray]:
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def _zipped_arrays(base: File, tree: File) -> Iterator[str]:
    one, other = _npz(base.data), _npz(tree.data)
    found = list(_named_arrays(one, other))
    yield from found
    if not found and not declared.KEYS.keys() & one.keys():
        yield "the arrays are equal, their bytes are not"


def _one_array(base: File, tree: File) -> Iterator[str]:
    one, other = (np.load(io.BytesIO(side.data), allow_pickle=False) for side in (base, tree))
    yield from list(_arrays("the array", one, other)) or ["the array is equal, its bytes are not"]


def _tensors(side: File) -> tuple[Any, dict[str, np.ndarray]]:
    """Return what a .safetensors file says of itself, and its tensors as bytes."""
    (length,) = struct.unpack_from("<Q", side.data)
    head = json.loads(side.data[8 : 8 + length])
    body = np.frombuffer(side.data, np.uint8)[8 + length :]
    about = head.pop("__metadata__", {})
    about = {key: json.loads(one) if one[:1] in "{[" else one for key, one in about.items()}
    tensors = {name: body[slice(*one["data_offsets"])] for name, one in head.items()}
    kinds = {name: [one["dtype"], one["shape"]] for name, one in head.items()}
    return _normal({"about": about, "kinds": kinds}, side, _varying(side.path)), tensors


def _weights(base: File, tree: File) -> Iterator[str]:
    (about, tensors), (other_about, other_tensors) = _tensors(base), _tensors(tree)
    yield from _trees(about, other_about)
    yield from _named_arrays(tensors, other_tensors)


def _networks(base: File, tree: File) -> Iterator[str]:
    """Compare ONNX files as graphs: names of modules that torch leaves in them do not count."""
    graphs = []
    for side in (base, tree):
        model = onnx.load_from_string(side.data)
        del model.metadata_props[:]
        for part in (model.graph, *model.functions):
            for node in part.node:
                node.doc_string = ""
                del node.metadata_props[:]
        graphs.append(normal_text(str(model), side).splitlines())
    yield from _rows(*graphs)


def _tables(base: File, tree: File) -> Iterator[str]:
    columns = []
    for side in (base, tree):
        table = parquet.read_table(io.BytesIO(side.data)).to_pydict()
        columns.append(_normal(table, side, _varying(side.path)))
    yield from _trees(*columns)


# ---- scenes


def _gltf(base: File, tree: File) -> Iterator[str]:
    parts = []
    for side in (base, tree):
        length = struct.unpack_from("<I", side.data, 12)[0]
        scene = json.loads(side.data[20 : 20 + length])
        parts.append((_normal(scene, side, frozenset()), side.data[20 + length :]))
    (scene, body), (other, other_body) = parts
    yield from _trees(scene, other)
    if body != other_body:
        yield from _byte_row("the buffer", body, other_body)


# ---- files of the game and others that must be equal to the byte


def _byte_row(name: str, base: bytes, tree: bytes) -> Iterator[str]:
    if len(base) != len(tree):
        yield f"{name}: {len(base):,} bytes, now {len(tree):,}"
    if base != tree:
        both = min(len(base), len(tree))
        one, other = (np.frombuffer(data[:both], np.uint8) for data in (base, tree))
        apart = np.flatnonzero(one != other)
        if len(apart):
            yield f"{name}: {len(apart):,} bytes differ, first at {int(apart[0]):,}"


def _bytes(base: File, tree: File) -> Iterator[str]:
    yield from _byte_row("the file", base.data, tree.data)


def _exact_texts(base: File, tree: File) -> Iterator[str]:
    one, other = (side.data.decode("utf-8", "replace").split() for side in (base, tree))
    yield from list(_first(_rows(one, other))) or ["the words are equal, the bytes are not"]


def _nbt_files(base: File, tree: File) -> Iterator[str]:
    values = []
    for side in (base, tree):
        plain = gzip.decompress(side.data) if side.data[:2] == b"\x1f\x8b" else side.data
        values.append(read_nbt(plain, little=side.path.endswith(".mcstructure")))
    yield from list(_first(_trees(*values))) or ["what it holds is equal, its bytes are not"]


def _chunks(data: bytes) -> dict[str, Any]:
    """Return the chunks of a region file by their place in it."""
    chunks = {}
    for number in range(1024):
        offset = int.from_bytes(data[4 * number : 4 * number + 3], "big") * 4096
        if offset:
            (length,) = struct.unpack_from(">I", data, offset)
            body = data[offset + 5 : offset + 4 + length]
            chunks[f"chunk {number % 32},{number // 32}"] = read_nbt(zlib.decompress(body))
    return chunks


def _regions(base: File, tree: File) -> Iterator[str]:
    told = list(_first(_trees(_chunks(base.data), _chunks(tree.data))))
    yield from told or ["the chunks are equal, the bytes are not"]


def _steps(side: File) -> list[Any]:
    """Return the records of a scene's journal without their times."""
    mark = b"w2m scene 1\n"
    if not side.data.startswith(mark):
        raise ValueError("no journal of a scene")
    at, steps = len(mark), []
    while at < len(side.data):
        (length,) = struct.unpack_from(">I", side.data, at)
        verb, number = struct.unpack_from(
            ">cI", record := zlib.decompress(side.data[at + 8 : at + 8 + length])
        )
        told: Any = record[5:]
        if verb == b"+":
            kind, _, content = told.partition(b"\n")
            told = [kind.decode(), read_nbt(content)]
        elif verb in b"-*":
            told = json.loads(told)[:1]
        else:
            told = told.decode()
        steps.append({"verb": verb.decode(), "number": number, "told": told})
        at += 8 + length
    return _normal(steps, side, _varying(side.path))


def _journals(base: File, tree: File) -> Iterator[str]:
    yield from _trees(_steps(base), _steps(tree))


def _members(side: File) -> dict[str, bytes]:
    if side.data[:2] == b"PK":
        with zipfile.ZipFile(io.BytesIO(side.data)) as file:
            return {name: file.read(name) for name in file.namelist()}
    with tarfile.open(fileobj=io.BytesIO(side.data)) as file:
        members = [(one.name, file.extractfile(one)) for one in file.getmembers() if one.isfile()]
        return {name: stream.read() for name, stream in members if stream}


def _archives(base: File, tree: File) -> Iterator[str]:
    one, other = _members(base), _members(tree)
    found = False
    for name in sorted(one.keys() | other.keys()):
        if name not in other or name not in one:
            found = True
            yield f"{name}: {'missing' if name in one else 'additional'}"
        elif one[name] != other[name]:
            sides = [
                side._replace(path=f"{side.path}/{name}", data=data)
                for side, data in ((base, one[name]), (tree, other[name]))
            ]
            for line in differences(*sides):
                found = True
                yield f"{name}: {line}"
    if not found and not _matches(declared.VARYING_ARCHIVES, base.path):
        yield "the members are equal, the bytes are not"


_BY_NAME: dict[str, Callable[[File, File], Iterator[str]]] = {
    "level.dat": _nbt_files,
    "journal.bin": _journals,
}
_BY_SUFFIX: dict[str, Callable[[File, File], Iterator[str]]] = {
    ".json": _documents(json.loads),
    ".jsonl": _documents(_lines_of_json),
    ".gltf": _documents(json.loads),
    ".yaml": _documents(yaml.safe_load),
    ".yml": _documents(yaml.safe_load),
    ".html": _pages,
    **dict.fromkeys((".md", ".txt", ".csv", ".tex", ".svg", ".py", ".sh", ".jinja"), _texts),
    **dict.fromkeys((".png", ".jpg", ".jpeg", ".webp", ".gif", ".apng"), _pictures),
    ".exr": _exrs,
    ".glb": _gltf,
    ".npz": _zipped_arrays,
    ".npy": _one_array,
    ".safetensors": _weights,
    ".onnx": _networks,
    ".parquet": _tables,
    **dict.fromkeys((".schem", ".litematic", ".nbt", ".mcstructure", ".dat"), _nbt_files),
    ".mca": _regions,
    ".mcfunction": _exact_texts,
    **dict.fromkeys((".zip", ".tar", ".mcworld", ".mcpack"), _archives),
}
