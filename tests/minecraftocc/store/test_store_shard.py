"""A shard survives anything: any beginning of its part, any damage at its end, a full disk."""

import errno
import os
import subprocess
import sys

import pytest
from occ_samples import AIR, CHAIR, PLANKS, sample

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.minecraftocc.store import shard as shard_module
from world2minecraft.minecraftocc.store.sample_files import FineTable, SampleFiles, pack_sample
from world2minecraft.minecraftocc.store.shard import ShardWriter

TABLE = FineTable((AIR, PLANKS, CHAIR))
SAMPLES = [sample(n) for n in range(3)]
KEYS = [one.key for one in SAMPLES]
FILES = [pack_sample(one, TABLE, SampleFiles()) for one in SAMPLES]


def write(path, most=None):
    """Write the shard from where it is; return how many samples were there."""
    with ShardWriter(path, KEYS) as shard:
        found = shard.done
        for members in FILES[shard.done : most]:
            shard.append(members)
        if most is None:
            shard.finish()
    return found


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "a.tar"
    assert write(path) == 0
    return path.read_bytes()


def ends():
    """Where each sample ends."""
    total, found = 0, [0]
    for members in FILES:
        total += sum(512 + len(data) + -len(data) % 512 for data in members.values())
        found.append(total)
    return found


def test_any_beginning_of_a_part_goes_on_to_the_same_bytes(tmp_path, whole):
    """Every end of a block and the bytes around it, and some within."""
    places = {n + d for n in range(0, len(whole) + 1, 512) for d in (-1, 0, 1)}
    places |= set(range(0, len(whole), 397))
    path = tmp_path / "a.tar"
    for length in sorted(one for one in places if 0 <= one <= len(whole)):
        (tmp_path / "a.tar.part").write_bytes(whole[:length])
        found = write(path)
        assert found == sum(end <= length for end in ends()) - 1
        assert path.read_bytes() == whole
        assert os.listdir(tmp_path) == ["a.tar"]
        path.unlink()


@pytest.mark.parametrize("tail", [b"\0" * 3000, b"\xff" * 700, b"ustar" * 1000])
def test_what_a_crash_of_the_machine_leaves_behind_is_cut_off(tmp_path, whole, tail):
    """Lengths may have reached the disk before data have: zeros, or anything."""
    for length in ends():
        (tmp_path / "a.tar.part").write_bytes(whole[:length] + tail)
        write(tmp_path / "a.tar")
        assert (tmp_path / "a.tar").read_bytes() == whole
        (tmp_path / "a.tar").unlink()


def test_a_sample_that_did_not_reach_the_disk_is_made_again(tmp_path, whole):
    damaged = bytearray(whole[: ends()[2]])
    damaged[ends()[1] + 600] ^= 0xFF  # Within the second sample's picture.
    (tmp_path / "a.tar.part").write_bytes(damaged)
    assert write(tmp_path / "a.tar") == 1
    assert (tmp_path / "a.tar").read_bytes() == whole


def test_a_part_of_other_samples_is_rewritten(tmp_path, whole):
    with ShardWriter(tmp_path / "a.tar", ["x-a-000001"]) as shard:
        shard.append(pack_sample(sample(9), TABLE, SampleFiles()))
    assert write(tmp_path / "a.tar") == 0
    assert (tmp_path / "a.tar").read_bytes() == whole


def test_a_finished_shard_is_left_alone(tmp_path):
    (tmp_path / "a.tar").write_bytes(b"finished")
    assert write(tmp_path / "a.tar") == 3
    assert (tmp_path / "a.tar").read_bytes() == b"finished"


@pytest.mark.parametrize("step", ["write", "fsync"])
def test_a_full_disk_is_one_line_and_costs_nothing(tmp_path, whole, step, monkeypatch):
    write(tmp_path / "a.tar", most=2)
    before = (tmp_path / "a.tar.part").read_bytes()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch, ShardWriter(tmp_path / "a.tar", KEYS) as shard:
        if step == "fsync":
            patch.setattr(os, "fsync", full)
        else:
            patch.setattr(shard, "_stream", HalfFull(shard._stream))
        with pytest.raises(OutputError) as caught:
            shard.append(FILES[2])
    told = "the disk is full; free some space and run the same command again to resume"
    assert str(caught.value) == f"{tmp_path / 'a.tar'}: {told}"
    assert (tmp_path / "a.tar.part").read_bytes() == before
    assert write(tmp_path / "a.tar") == 2
    assert (tmp_path / "a.tar").read_bytes() == whole


class HalfFull:
    """A stream on a disk that is full after a thousand bytes more."""

    def __init__(self, stream):
        self._stream, self._left = stream, 1000

    def write(self, data):
        if not self._left:
            raise OSError(errno.ENOSPC, "No space left on device")
        count = self._stream.write(data[: self._left])
        self._left -= count
        return count

    def __getattr__(self, name):
        return getattr(self._stream, name)


HOLD = """
import sys, time
from pathlib import Path
from world2minecraft.minecraftocc.store.shard import ShardWriter
shard = ShardWriter(Path(sys.argv[1]), ["a-a-000001"])
print("held", flush=True)
time.sleep(600)
"""


def test_two_processes_do_not_write_one_shard(tmp_path, whole, monkeypatch):
    words = [sys.executable, "-c", HOLD, str(tmp_path / "a.tar")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout.readline() == "held\n"
        monkeypatch.setattr(shard_module, "PATIENCE_S", 0.2)
        with pytest.raises(ConflictError, match="another process is writing this file"):
            write(tmp_path / "a.tar")
        other.kill()
    monkeypatch.undo()
    write(tmp_path / "a.tar")
    assert (tmp_path / "a.tar").read_bytes() == whole
