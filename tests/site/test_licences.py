"""Whatever is shipped and is no code has a row on the page of licences, and each row has a file."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "world2minecraft"
# Code, and what is not shipped.
CODE = {".py", ".pyc", ".typed"}


def shipped():
    for path in SOURCE.rglob("*"):
        inner = path.relative_to(SOURCE).as_posix()
        if path.is_file() and path.suffix not in CODE and not inner.startswith("sceneforge/web/"):
            yield inner


def patterns():
    """The files that the rows of the page name; a bare name lies beside the one before it."""
    for row in re.findall(
        r"^\| (`.+?`.*?) \|", (ROOT / "docs/reference/licences.md").read_text(), re.M
    ):
        folder = ""
        for name in re.findall(r"`([^`]+)`", row):
            folder = name.rpartition("/")[0] or folder
            yield name if "/" in name else f"{folder}/{name}"


def fits(pattern, name):
    words = re.escape(pattern).replace(r"\*\*", ".*").replace(r"\*", "[^/]*")
    return re.fullmatch(words, name)


def test_each_file_that_is_shipped_has_a_row():
    rows = list(patterns())
    notices = ("NOTICE-three.txt", "NOTICE-minecraft-data.txt")
    bare = [one for one in shipped() if not any(fits(row, one) for row in rows)]
    assert not [one for one in bare if not one.endswith(notices)]


def test_each_row_has_a_file():
    names = list(shipped())
    assert not [row for row in patterns() if not any(fits(row, one) for one in names)]


def test_the_notices_of_others_are_shipped_and_named():
    notice = (ROOT / "NOTICE").read_text()
    for path in ("sceneforge/NOTICE-three.txt", "minecraft/data/NOTICE-minecraft-data.txt"):
        assert "MIT" in (SOURCE / path).read_text()
        assert path.rpartition("/")[2] in notice
    package = (SOURCE / "sceneforge/web/package.json").read_text()
    version = re.search(r'"three": "([\d.]+)"', package)[1]
    assert f"three.js {version} " in (SOURCE / "sceneforge/NOTICE-three.txt").read_text()
