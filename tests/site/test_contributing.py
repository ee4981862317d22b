"""CONTRIBUTING explains the tree: what it names is there."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "CONTRIBUTING.md").read_text()
SOURCE = ROOT / "src" / "world2minecraft"


def test_every_file_and_folder_named_is_there():
    named = set(re.findall(r"`((?:[a-z_0-9]+/)+[a-z_0-9]*(?:\.py)?|[a-z_]+\.py)`", PAGE))
    assert len(named) > 40
    assert not [
        path
        for path in named
        if not any((b / path).exists() for b in (ROOT, SOURCE, SOURCE.parent))
    ]


def test_every_package_has_a_row():
    rows = set(re.findall(r"^\| `([a-z]+(?:_[a-z]+)*)(?:\.py)?` \|", PAGE, re.MULTILINE))
    packages = {path.stem for path in SOURCE.iterdir() if path.name[0] not in "_."}
    assert packages - rows <= {"weights", "py"}
