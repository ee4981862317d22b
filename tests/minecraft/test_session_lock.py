"""The game's lock: a Java program that locks as the game does keeps us out, and we keep it out."""

import errno
import shutil
import subprocess
import types

import pytest

from world2minecraft.core.errors import ConflictError, InputError, OutputError
from world2minecraft.minecraft.worlds import session_lock as locks
from world2minecraft.minecraft.worlds.session_lock import SNOWMAN, session_lock

# As the game does it: the file is made, the snowman written, the whole channel locked.
GAME = """
import java.nio.ByteBuffer;
import java.nio.channels.FileChannel;
import java.nio.file.Path;
import java.nio.file.StandardOpenOption;

public class Game {
    public static void main(String[] words) throws Exception {
        var channel = FileChannel.open(
            Path.of(words[0]), StandardOpenOption.CREATE, StandardOpenOption.WRITE);
        channel.write(ByteBuffer.wrap("\\u2603".getBytes("UTF-8")));
        channel.force(true);
        System.out.println(channel.tryLock() == null ? "refused" : "held");
        System.in.read();
    }
}
"""


@pytest.fixture
def world(tmp_path):
    (tmp_path / "world").mkdir()
    (tmp_path / "world" / "level.dat").write_bytes(b"level")
    return tmp_path / "world"


def test_a_lock_file_is_removed_only_where_it_was_created(world):
    with session_lock(world):
        assert (world / "session.lock").read_bytes() == SNOWMAN
    assert not (world / "session.lock").exists()
    (world / "session.lock").write_bytes(b"old")
    with session_lock(world):
        pass
    assert (world / "session.lock").read_bytes() == b"old"


def test_the_lock_is_given_back_after_an_error(world):
    with pytest.raises(RuntimeError), session_lock(world):
        raise RuntimeError
    with session_lock(world):
        pass


def test_no_world_has_no_lock(tmp_path):
    with pytest.raises(InputError, match="is not a world folder"), session_lock(tmp_path):
        pass
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not shutil.which("java"), reason="Java is not installed")
def test_a_java_program_and_we_keep_each_other_out(world, tmp_path):
    (tmp_path / "Game.java").write_text(GAME)
    words = ["java", str(tmp_path / "Game.java"), str(world / "session.lock")]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen(words, **pipes) as game:
        assert game.stdout.readline() == "held\n"
        with pytest.raises(ConflictError), session_lock(world):
            pass
        game.stdin.close()
    with session_lock(world):
        done = subprocess.run(words, input="", capture_output=True, text=True, check=True)
    assert done.stdout == "refused\n"


@pytest.mark.parametrize(
    ("code", "error", "text"),
    [
        (errno.EACCES, ConflictError, "is open in the game"),
        (errno.EAGAIN, ConflictError, "is open in the game"),
        (errno.ENOLCK, OutputError, "cannot lock session.lock: "),
    ],
)
@pytest.mark.parametrize("system", ["posix", "windows"])
def test_what_the_system_says_is_told_apart(world, monkeypatch, system, code, error, text):
    def refuse(*_):
        raise OSError(code, "no")

    fake = types.SimpleNamespace(
        lockf=refuse, locking=refuse, LOCK_EX=1, LOCK_NB=2, LK_NBLCK=3, LK_UNLCK=4
    )
    monkeypatch.setattr(locks, "fcntl", fake if system == "posix" else None)
    monkeypatch.setattr(locks, "msvcrt", fake if system == "windows" else None)
    (world / "session.lock").write_bytes(SNOWMAN)
    with pytest.raises(error, match=text), session_lock(world):
        pass
    assert (world / "session.lock").read_bytes() == SNOWMAN
