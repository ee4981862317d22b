"""Files made to take memory: each ends in a result or a typed error, below 512 MB."""

import struct
import subprocess
import sys
import zipfile
import zlib

import numpy as np
import pytest

from world2minecraft.formats.gltf import GlbWriter
from world2minecraft.minecraft.bedrock.nbt_little_endian import write_little

pytest.importorskip("resource")  # Windows has none.

LIMIT_MB = 512
READ = """
import resource, sys
from world2minecraft.core.errors import InputError
from world2minecraft.formats.volume_formats import read_volume
for path in sys.argv[1:]:
    try:
        volume = read_volume(path)
        print("read", volume.states.size)
        del volume
    except InputError as error:
        print("refused", error.reason)
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
if sys.platform == "linux":  # There that one counts what the parent held, too.
    peak = next(int(line.split()[1]) for line in open("/proc/self/status") if "VmHWM" in line)
print(peak / (1 << 20 if sys.platform == "darwin" else 1 << 10))
"""


def large_structure() -> bytes:
    """As many blocks as are read at most, in a palette with water and a fence."""
    side = 228
    cells = np.zeros(side**3, np.int32)
    cells[::7] = 1
    entry = {"name": "minecraft:oak_fence", "states": {}, "version": 1}
    palette = [{"name": "minecraft:air", "states": {}, "version": 1}, entry]
    held = {"block_indices": [cells, cells - 1], "palette": {"default": {"block_palette": palette}}}
    return write_little({"size": np.array([side] * 3, np.int32), "structure": held})


def bomb(numbers: bytes) -> bytes:
    """A .glb whose blocks unpack to more than is read."""
    writer = GlbWriter("test")
    writer.tree["extras"] = {"world2minecraft": {"blocks": writer.view(numbers)}}
    return writer.to_bytes()


def gzip_of_zeros(count: int) -> bytes:
    packer = zlib.compressobj(1, zlib.DEFLATED, 31)
    chunk = bytes(1 << 20)
    return b"".join([*(packer.compress(chunk) for _ in range(count >> 20)), packer.flush()])


def wide_json() -> bytes:
    text = b'{"a":[' + b"[]," * 1_000_000 + b"[]]}"
    text += b" " * (-len(text) % 4)
    head = struct.pack("<III", 0x46546C67, 2, 20 + len(text))
    return head + struct.pack("<II", len(text), 0x4E4F534A) + text


FILES = {
    "blank.mcfunction": (
        lambda: b"\n" * (60 << 20),
        "refused exceeds the limit of 4,000,000 lines",
    ),
    "wide.mcfunction": (
        lambda: b"setblock 0 0 0 a{b:[" + b"999," * 600_000 + b"9]}",
        "refused contains an invalid command: SNBT text exceeds the limit of 500,000 values",
    ),
    "deep.mcfunction": (
        lambda: b"summon cat 0 0 0 {a:" + b"[" * (1 << 20),
        "refused contains an invalid command: SNBT text exceeds the limit of 100 nested tags",
    ),
    "full.mcfunction": (lambda: b"fill 0 0 0 399 399 399 stone\n" * 4, "read 64000000"),
    "again.mcfunction": (
        lambda: b"fill 0 0 0 399 399 399 stone\n" * 5,
        "refused exceeds the limit of",
    ),
    "many.mcfunction": (
        lambda: b"".join(b"setblock 0 %d 0 a%d\n" % (n % 300, n) for n in range(66_000)),
        "refused has 66,001 block states, the limit is 65,535",
    ),
    "large.mcstructure": (large_structure, "read 11852352"),
    "count.mcstructure": (
        lambda: b"\x0a\0\0\x09\x04\0size\x03" + struct.pack("<i", (1 << 31) - 1) + bytes(60 << 20),
        "refused is not valid little-endian NBT: 2,147,483,647 values are declared",
    ),
    "bomb.glb": (lambda: bomb(gzip_of_zeros(240 << 20)), "refused exceeds the limit of"),
    "wide.glb": (wide_json, "refused contains no blocks"),
}


def pack_bomb(path) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("data/a/function/build/part_0.mcfunction", bytes(80 << 20))


def test_files_made_to_take_memory_do_not(tmp_path):
    """All in one process of their own, so that its peak is theirs."""
    for name, (make, _) in FILES.items():
        (tmp_path / name).write_bytes(make())
    pack_bomb(tmp_path / "bomb.zip")
    wanted = [*(reason for _, reason in FILES.values()), "refused exceeds the limit of 67,108,864"]
    paths = [str(tmp_path / name) for name in (*FILES, "bomb.zip")]
    ran = subprocess.run(
        [sys.executable, "-c", READ, *paths],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr[-500:]
    *told, peak_mb = ran.stdout.strip().splitlines()
    assert [line[: len(start)] for line, start in zip(told, wanted, strict=True)] == wanted
    assert float(peak_mb) < LIMIT_MB
