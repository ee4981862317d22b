"""Games are found where launchers keep them, on each system; strange settings harm nothing."""

import json
from pathlib import Path

import pytest

from world2minecraft.minecraft.worlds.launchers import find_games


def instance(root: Path, name: str, title: str, version: str = "1.20.1", folder="minecraft"):
    path = root / "instances" / name
    (path / folder).mkdir(parents=True)
    (path / "instance.cfg").write_text(f"[General]\nInstanceType=OneSix\nname={title}\n")
    components = [
        {"uid": "org.lwjgl3", "version": "3"},
        {"uid": "net.minecraft", "version": version},
    ]
    (path / "mmc-pack.json").write_text(json.dumps({"components": components}))
    return path / folder


@pytest.mark.parametrize(
    ("platform", "environment", "launcher", "prism"),
    [
        ("linux", {}, ".minecraft", ".local/share/PrismLauncher"),
        ("linux", {"XDG_DATA_HOME": "{home}/data"}, ".minecraft", "data/PrismLauncher"),
        (
            "linux",
            {},
            ".var/app/com.mojang.Minecraft/.minecraft",
            ".var/app/org.prismlauncher.PrismLauncher/data/PrismLauncher",
        ),
        (
            "darwin",
            {},
            "Library/Application Support/minecraft",
            "Library/Application Support/PrismLauncher",
        ),
        (
            "win32",
            {"APPDATA": "{home}/Roaming"},
            "Roaming/.minecraft",
            "Roaming/PrismLauncher",
        ),
        ("win32", {}, "AppData/Roaming/.minecraft", "scoop/persist/prismlauncher"),
        ("linux", {"PRISMLAUNCHER_DATA_DIR": "{home}/usb"}, ".minecraft", "usb"),
    ],
)
def test_each_system_has_its_places(tmp_path, platform, environment, launcher, prism):
    settings = {key: value.format(home=tmp_path) for key, value in environment.items()}
    assert find_games(platform, tmp_path, settings) == []
    (tmp_path / launcher).mkdir(parents=True)
    first = instance(tmp_path / prism, "a", "My Pack", "1.21.1")
    second = instance(tmp_path / prism, "b", "Older", "1.19", folder=".minecraft")
    games = find_games(platform, tmp_path, settings)
    assert [(game.name, game.saves, game.version) for game in games] == [
        ("Minecraft launcher", tmp_path / launcher / "saves", None),
        ("Prism: My Pack", first / "saves", "1.21.1"),
        ("Prism: Older", second / "saves", "1.19"),
    ]


@pytest.mark.parametrize(
    ("platform", "root"),
    [
        ("linux", ".local/share/multimc"),
        ("linux", "MultiMC"),
        ("win32", "MultiMC"),
        ("win32", "Downloads/MultiMC"),
        ("darwin", "Applications/MultiMC.app/Data"),
    ],
)
def test_multimc_is_found_in_its_usual_places(tmp_path, platform, root):
    game = instance(tmp_path / root, "one", "One")
    assert [g.saves for g in find_games(platform, tmp_path, {})] == [game / "saves"]


def test_installations_with_their_own_directory_are_games(tmp_path):
    (tmp_path / ".minecraft").mkdir()
    (tmp_path / "modded").mkdir()
    profiles = {
        "1": {"name": "Modded", "gameDir": str(tmp_path / "modded")},
        "2": {"name": "", "gameDir": str(tmp_path / "gone")},
        "3": {"name": "The same", "gameDir": str(tmp_path / ".minecraft")},
        "4": {"name": "Relative", "gameDir": "modded"},
        "5": "no profile",
    }
    (tmp_path / ".minecraft" / "launcher_profiles.json").write_text(
        json.dumps({"profiles": profiles})
    )
    assert [(g.name, g.saves) for g in find_games("linux", tmp_path, {})] == [
        ("Minecraft launcher", tmp_path / ".minecraft" / "saves"),
        ("Minecraft launcher: Modded", tmp_path / "modded" / "saves"),
    ]


@pytest.mark.parametrize("quoted", [True, False])
def test_instances_may_lie_elsewhere(tmp_path, quoted):
    root, folder = tmp_path / ".local/share/PrismLauncher", tmp_path / "my packs"
    root.mkdir(parents=True)
    value = json.dumps(str(folder)) if quoted else str(folder)
    (root / "prismlauncher.cfg").write_text(f"[General]\nInstanceDir={value}\n")
    game = instance(tmp_path / "x", "a", '"Pack \\"A\\""' if quoted else "Pack A")
    (tmp_path / "x" / "instances").rename(folder)
    found = find_games("linux", tmp_path, {})
    assert [g.saves for g in found] == [folder / "a" / "minecraft" / "saves"]
    assert found[0].name == ('Prism: Pack "A"' if quoted else "Prism: Pack A")
    assert not game.exists()


@pytest.mark.parametrize("junk", [b"", b"[]", b"{", b"\xff\xfe\0", b'{"profiles": 7}', b"[" * 5000])
def test_broken_settings_are_passed_over(tmp_path, junk):
    (tmp_path / ".minecraft").mkdir()
    (tmp_path / ".minecraft" / "launcher_profiles.json").write_bytes(junk)
    game = instance(tmp_path / ".local/share/PrismLauncher", "a", "A")
    for name in ("instance.cfg", "mmc-pack.json"):
        (game.parent / name).write_bytes(junk)
    (tmp_path / ".local/share/PrismLauncher/prismlauncher.cfg").write_bytes(junk)
    found = find_games("linux", tmp_path, {})
    assert [(g.name, g.version) for g in found] == [
        ("Minecraft launcher", None),
        ("Prism: a", None),
    ]


def test_a_name_with_control_characters_is_shown_without_them(tmp_path):
    instance(tmp_path / ".local/share/PrismLauncher", "a", "Red\x1b[31m   pack")
    assert find_games("linux", tmp_path, {})[0].name == "Prism: Red[31m pack"


def test_missing_drives_and_unreadable_folders_are_skipped(tmp_path, monkeypatch):
    is_dir, iterdir = Path.is_dir, Path.iterdir

    def guarded(look):
        def of(path):
            if "locked" in path.name:
                raise PermissionError(13, "Permission denied", str(path))
            return look(path)

        return of

    (tmp_path / ".minecraft").mkdir()
    profiles = {"a": {"gameDir": str(tmp_path / "locked drive"), "name": "away"}}
    (tmp_path / ".minecraft" / "launcher_profiles.json").write_text(
        json.dumps({"profiles": profiles})
    )
    seen = instance(tmp_path / ".local/share/PrismLauncher", "a", "Mine")
    instance(tmp_path / ".local/share/PrismLauncher", "locked", "Another's")
    instances = tmp_path / "locked instances"
    instances.mkdir()
    poly = tmp_path / ".local/share/PolyMC"
    poly.mkdir()
    (poly / "polymc.cfg").write_text(f"InstanceDir={instances}\n")
    monkeypatch.setattr(Path, "is_dir", guarded(is_dir))
    monkeypatch.setattr(Path, "iterdir", guarded(iterdir))
    saves = [game.saves for game in find_games("linux", tmp_path, {})]
    assert saves == [tmp_path / ".minecraft" / "saves", seen / "saves"]
