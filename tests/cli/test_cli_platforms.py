"""Names that are no UTF-8, homes that cannot be written, and rules of other systems' paths."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.core.errors import UsageError
from world2minecraft.core.file_names import is_text, readable_name
from world2minecraft.core.files import write_text
from world2minecraft.formats.occupancy_files import labels_grid
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.furniture.user_library import check_name
from world2minecraft.navigation.records import to_json_line
from world2minecraft.navigation.types import Episode, Instruction, Stance
from world2minecraft.paper.layouts.scene_selection import folder_names

LATIN = os.fsdecode(b"\xe9 \xff room")  # As an old disk or archive has it.
NFD = "cafe\u0301"  # As macOS stores it.
LONG = "/".join(["a long name of a folder " * 8] * 6)  # 1,157 characters.
NAMES = [LATIN, NFD, "日本語 🏠", "%41&amp;'\"", "-o", LONG]


@pytest.fixture
def room(tmp_path) -> Path:
    """A small room without furniture."""
    labels = np.zeros((24, 24, 28), np.uint8)
    labels[:, :, 0], labels[0], labels[:, 0] = 2, 3, 3
    write_room(tmp_path / "room.npz", labels_grid(labels), np.eye(4))
    return tmp_path / "room.npz"


def run_in(environment: dict[str, str], words: list[str]) -> subprocess.CompletedProcess:
    """Run the command line in a process with more environment variables."""
    command = [sys.executable, "-m", "world2minecraft", *words]
    return subprocess.run(command, env=os.environ | environment, capture_output=True, check=False)


@pytest.mark.parametrize("name", NAMES)
def test_a_room_is_built_and_converted_under_any_name(name, room, tmp_path, capsys):
    place = tmp_path / "here" / name
    place.mkdir(parents=True)
    own = shutil.copy(room, place / f"{name.split('/')[0]}.npz")
    run, schem = place / "OUT", place / f"{name.split('/')[0]}.schem"
    for words in (
        ["build", str(own), "--out", str(run)],
        ["convert", str(run), str(schem)],
        ["convert", str(schem), str(place / "WORLD")],
        ["render", str(schem), "-o", str(place / "look.png"), "--size", "64x48"],
        ["share", str(run), "-o", str(place / "room.html")],
        ["install", str(run), "--saves", str(place / "saves")],
    ):
        assert cli.run(words) == 0, capsys.readouterr().err
    assert (run / "build/world/level.dat").is_file() and (place / "room.html").is_file()


def test_a_missing_file_of_any_name_is_named_in_one_line(tmp_path, capsys):
    assert cli.run(["build", str(tmp_path / LATIN), "--out", str(tmp_path / "OUT")]) == 3
    assert capsys.readouterr().err.count("\n") == 1


def test_text_of_names_is_readable(tmp_path):
    assert readable_name(LATIN) == "\ufffd \ufffd room" and readable_name("é") == "é"
    assert is_text("é") and not is_text(LATIN)
    write_text(tmp_path / "page.html", f"<p>{LATIN}")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == "<p>\\udce9 \\udcff room"


def test_a_scene_of_any_name_is_recorded_and_no_other_text():
    told = Instruction("go", "human", "goal", ())
    feet = (1.0, 2.0, 3.0)
    episode = Episode("one", f"/{LATIN}", "den", Stance(*feet), (feet,), "lamp", told)
    line = to_json_line(episode)
    assert line.isascii() and r"/\udce9 \udcff room" in line
    for wrong in (
        Episode("one", "/\ud800", "den", Stance(*feet), (feet,), "lamp", told),
        Episode("one", "/x", "den", Stance(*feet), (feet,), LATIN, told),
    ):
        with pytest.raises(UsageError, match="cannot be written as JSON"):
            to_json_line(wrong)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no C locale")
def test_the_c_locale_prints_and_reads_any_name(room, tmp_path):
    place = tmp_path / LATIN
    place.mkdir()
    own = shutil.copy(room, place / f"{LATIN}.npz")
    locale = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    words = ["build", str(own), "--out", str(place / "OUT")]
    done = run_in(locale, words)
    assert done.returncode == 0, done.stderr
    assert os.fsencode(place) in done.stdout


def test_a_home_that_cannot_be_written_is_no_obstacle(room, tmp_path):
    (tmp_path / "home").write_text("a file")  # Permissions do not stop an administrator.
    folders = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME")
    nowhere = dict.fromkeys(folders, str(tmp_path / "home" / "nobody"))
    words = ["build", str(room), "--out", str(tmp_path / "OUT")]
    done = run_in(nowhere, words)
    assert done.returncode == 0, done.stderr


def test_folders_of_scenes_differ_on_systems_that_ignore_case():
    scenes = [SimpleNamespace(name=name) for name in ("Bed-1", "bed-1", "CON", "a/b", "a?b", "..")]
    names = folder_names(scenes)
    assert names == ["Bed-1", "bed-1_1", "CON_2", "a_b", "a_b_4", "scene_5"]


def test_furniture_has_no_name_that_windows_reserves():
    with pytest.raises(UsageError, match="Windows reserves the name 'aux'"):
        check_name("aux")
