"""Makes docs/gallery.md and its pictures, from scenes of our own and nothing else.

    python tools/make_gallery.py            some minutes, 200 MB in a folder that is thrown away

Every picture's caption is the commands that make it, so that anyone can make it again; they are run
here as they stand there.
"""

import contextlib
import os
import shlex
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from world2minecraft import cli
from world2minecraft.files import write_bytes, write_text

DOCS = Path(__file__).resolve().parents[1] / "docs"
FOLDER = "images/gallery"
SIZE = "--size 960x600 --format jpg --quality 82"


class Shot(NamedTuple):
    """A picture: its name, what it shows, the words of its w2m render, and which one of those."""

    stem: str
    title: str
    render: str
    take: int = 0


class Scene(NamedTuple):
    """What is made first, and the pictures of it."""

    title: str
    about: str
    make: tuple[str, ...]
    shots: tuple[Shot, ...]


SCENES = (
    Scene(
        "Scanned and rebuilt",
        "Generated rooms, scanned by a virtual depth camera, and rebuilt from the scan alone.",
        (
            "w2m demo --kind kitchen --seed 3 --out kitchen",
            "w2m demo --kind bed --seed 4 --out bed",
        ),
        (
            Shot("kitchen", "A kitchen, from outside", "kitchen --orbit --frames 4", 2),
            Shot("kitchen-inside", "and inside", "kitchen --tour --frames 8", 4),
            Shot("bed", "A bedroom, from outside", "bed --orbit --frames 4"),
            Shot("bed-inside", "and inside", "bed --tour --frames 8", 6),
        ),
    ),
    Scene(
        "Generated houses",
        "Furnished houses in styles that each draws for itself: block worlds with exact truth.",
        ("w2m rooms generate --houses 4 --seed 21 --worlds houses",),
        (
            Shot("house-1", "Two storeys, opened", "houses/house_0001 --orbit --frames 4"),
            Shot("house-2", "One, opened", "houses/house_0002 --orbit --frames 4"),
            Shot("room-1", "A living room", "houses/house_0001 --tour --frames 8", 3),
            Shot("room-2", "Another", "houses/house_0002 --tour --frames 8", 4),
            Shot("room-3", "and one in lime", "houses/house_0003 --tour --frames 8", 1),
            Shot("room-4", "A dining room", "houses/house_0004 --tour --frames 8", 2),
        ),
    ),
    Scene(
        "One room, three styles",
        "The same run, built of vanilla blocks, of block displays, and cell by cell.",
        (
            "w2m build kitchen --out fine --style display --blocks-per-metre 2",
            "w2m build kitchen --out coarse --style blocks --blocks-per-metre 2",
            "w2m build kitchen --out exact --blocks-per-metre 12.5",
        ),
        (
            Shot("style-blocks", "Blocks, 2 a metre", "coarse --orbit --frames 4", 2),
            Shot("style-display", "Displays, 2 a metre", "fine --orbit --frames 4", 2),
            Shot("style-exact", "A block a voxel", "exact --orbit --frames 4"),
        ),
    ),
)


def main() -> None:
    """Make the scenes, draw the pictures, write the page."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for scene in SCENES:
            for line in scene.make:
                _run(line)
            for shot in scene.shots:
                _run(command_of(shot))
                taken = Path("shots", shot.stem, f"{shot.take:06d}.jpg").read_bytes()
                write_bytes(DOCS / FOLDER / f"{shot.stem}.jpg", taken)
    write_text(DOCS / "gallery.md", page())


def command_of(shot: Shot) -> str:
    """Return the command that draws a picture, and some beside it."""
    return f"w2m render {shot.render} {SIZE} --out shots/{shot.stem}"


def page() -> str:
    """Return the page's text."""
    head = (
        "# Gallery\n\nScenes of our own, drawn by the program's renderer with its own textures.\n"
    )
    parts = [_section(scene) for scene in SCENES]
    foot = "`python tools/make_gallery.py` makes this page and its pictures.\n"
    return "\n".join([head, *parts, foot])


def _section(scene: Scene) -> str:
    pictures = "\n".join(
        f"<figure markdown>\n![{shot.title}]({FOLDER}/{shot.stem}.jpg)\n"
        f"<figcaption>{shot.title}</figcaption>\n</figure>\n"
        for shot in scene.shots
    )
    commands = "\n".join([*scene.make, *map(command_of, scene.shots)])
    return (
        f"## {scene.title}\n\n{scene.about}\n\n"
        f'<div class="gallery" markdown>\n\n{pictures}\n</div>\n\n'
        f"<details markdown><summary>The commands</summary>\n\n```\n{commands}\n```\n\n</details>\n"
    )


def _run(line: str) -> None:
    words = shlex.split(line)[1:]
    code = cli.run(words)
    if code != os.EX_OK:
        sys.exit(f"{line} ended with {code}")


if __name__ == "__main__":
    main()
