"""What tests of reconstructions share."""

from pathlib import Path

import pytest

from world2minecraft.procgen import generate_room, scan_room


@pytest.fixture(scope="session")
def dining_scan(made_once) -> Path:
    """A dining room in 16 small frames with label images, its truth beside it; do not change it."""

    def make(folder: Path) -> None:
        room = generate_room(3, kind="dining")
        scan_room(room, folder, frames=16, seed=3, width=320, height=240, with_labels=True)

    return made_once("dining_scan", make)
