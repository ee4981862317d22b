"""``w2m install``: where it goes, what to click, and when it asks."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.worlds.world_writer import write_world


@pytest.fixture
def out(tmp_path):
    volume = BlockVolume(
        np.ones((2, 2, 2), np.uint16),
        (AIR, "minecraft:stone"),
        np.zeros((2, 2, 2), np.uint8),
        np.zeros((2, 2, 2), np.uint16),
        (0, 64, 0),
        np.eye(4),
    )
    folder = tmp_path / "run" / "build" / "world"
    write_world(volume, folder, name="Kitchen", spawn=(0, 66, 0), spawn_yaw_deg=0)
    return tmp_path / "run"


@pytest.fixture
def home(tmp_path, monkeypatch):
    for name in ("APPDATA", "LOCALAPPDATA", "XDG_DATA_HOME", "PRISMLAUNCHER_DATA_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    monkeypatch.setattr("sys.platform", "linux")
    (tmp_path / "home").mkdir()
    return tmp_path / "home"


def pack(home, name, version):
    folder = home / ".local/share/PrismLauncher/instances" / name
    (folder / "minecraft").mkdir(parents=True)
    (folder / "instance.cfg").write_text(f"name={name}\n")
    components = f'{{"components": [{{"uid": "net.minecraft", "version": "{version}"}}]}}'
    (folder / "mmc-pack.json").write_text(components)
    return folder / "minecraft" / "saves"


def test_the_world_goes_to_the_only_game(out, home, capsys):
    (home / ".minecraft").mkdir()
    assert cli.run(["install", str(out)]) == 0
    target = home / ".minecraft" / "saves" / "Kitchen"
    assert (target / "level.dat").is_file()
    assert capsys.readouterr().out == (
        f"Copied to {target}\n\n"
        "  1. start Minecraft launcher\n"
        "  2. Singleplayer\n"
        "  3. Kitchen, then Play Selected World\n\n"
        "In 1.20.5 or newer, /function w2m:human_size scales you to the size of a person.\n"
    )


def test_of_several_games_one_is_chosen(out, home, capsys):
    (home / ".minecraft").mkdir()
    saves = pack(home, "Fabric", "1.21.1")
    pack(home, "Old", "1.20")
    assert cli.run(["install", str(out)]) == 2
    assert capsys.readouterr().err == (
        "error: 3 games found; choose one (--game NUMBER): 1 Minecraft launcher, "
        "2 Prism: Fabric, 3 Prism: Old\n"
    )
    assert cli.run(["install", str(out), "--game", "fab"]) == 0
    assert cli.run(["install", str(out), "--game", "2", "--name", "Two"]) == 0
    assert sorted(os.listdir(saves)) == ["Kitchen", "Two"]
    assert "note:" not in capsys.readouterr().out
    assert cli.run(["install", str(out), "--game", "old"]) == 0
    assert (
        "note: Minecraft 1.20 cannot open this newer world; build the world again with "
        "--mc-version 1.20\n"
    ) in capsys.readouterr().out
    assert cli.run(["install", "--list"]) == 0
    assert capsys.readouterr().out.splitlines()[1] == f" 2  Prism: Fabric (1.21.1)  {saves}"
    assert cli.run(["install", "--list", "--json"]) == 0
    fabric = {"number": 2, "name": "Prism: Fabric", "version": "1.21.1", "saves": str(saves)}
    assert json.loads(capsys.readouterr().out)[1] == fabric


@pytest.mark.parametrize(
    ("words", "code", "reason"),
    [
        (["install"], 2, "no world given; add the run folder, as in w2m install OUT"),
        (["install", "{out}"], 2, "no game found; name a saves folder (--saves DIR)"),
        (
            ["install", "{home}", "--saves", "{home}"],
            3,
            "contains no world (build/world/level.dat)",
        ),
        (
            ["install", "{out}", "--saves", "{home}/a/b"],
            3,
            "parent folder not found; give the saves folder",
        ),
        (
            ["install", "{out}", "--saves", "{home}", "--name", "/"],
            2,
            "name must contain letters or digits",
        ),
    ],
)
def test_what_cannot_be_is_one_line(out, home, capsys, words, code, reason):
    assert cli.run([word.format(out=out, home=home) for word in words]) == code
    printed, err = capsys.readouterr()
    assert (printed, err.count("\n")) == ("", 1)
    assert reason in err


@pytest.mark.parametrize(
    ("wanted", "reason"),
    [
        ("7", "--game 7 does not exist, because only 2 games were found; run w2m install --list"),
        (
            "bedrock",
            "no game is named 'bedrock'; choose one (--game NUMBER): 1 Minecraft launcher",
        ),
        ("minecraft launcher", None),
    ],
)
def test_a_game_is_chosen_by_number_or_name(out, home, capsys, wanted, reason):
    (home / ".minecraft").mkdir()
    pack(home, "A", "1.20.1")
    assert cli.run(["install", str(out), "--game", wanted]) == (2 if reason else 0)
    assert reason is None or reason in capsys.readouterr().err


def test_a_saves_folder_that_is_given_is_taken(out, home, tmp_path):
    for source in (out, out / "build", out / "build" / "world"):
        assert cli.run(["install", str(source), "--saves", str(tmp_path / "worlds")]) == 0
    names = ["Kitchen", "Kitchen (2)", "Kitchen (3)"]
    assert sorted(os.listdir(tmp_path / "worlds")) == names
