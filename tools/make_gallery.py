"""Make docs/gallery.md and the pictures of it, the tutorials and the README, of own scenes alone.

    python tools/make_gallery.py            some minutes, 300 MB in a folder that is thrown away

The page shows the commands that make the pictures, so that anyone can repeat them.
"""

import contextlib
import io
import os
import shlex
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from make_film import animated, film
from PIL import Image

from world2minecraft import cli
from world2minecraft.core.files import write_bytes, write_text

DOCS = Path(__file__).resolve().parents[1] / "docs"
GALLERY, TUTORIALS = "images/gallery", "images/tutorials"
SIZE = "--size 960x600 --format jpg --quality 82"
WIDEST_PX, QUALITY = 1600, 85
NORDIC = """\
name: nordic
blocks: [white_concrete, light_gray_concrete, birch_planks, birch_slab, birch_stairs,
         dark_oak_planks, red_wool, glass, glass_pane]
"""


class Shot(NamedTuple):
    """A picture: its name, what it shows, the command that makes it, and the file that it is in."""

    stem: str
    title: str
    command: str
    file: str


def render(stem: str, title: str, words: str, take: int = 0) -> Shot:
    """Return one of the pictures that ``w2m render`` with these words makes."""
    command = f"w2m render {words} {SIZE} --out shots/{stem}"
    return Shot(stem, title, command, f"shots/{stem}/{take:06d}.jpg")


class Scene(NamedTuple):
    """A world that is made first, and the pictures of it."""

    title: str
    about: str
    make: tuple[str, ...]
    shots: tuple[Shot, ...]


SCENES = (
    Scene(
        "Reconstructed rooms",
        "Generated rooms, scanned by a virtual depth camera and reconstructed from the scan.",
        (
            "w2m demo --kind kitchen --seed 3 --out kitchen",
            "w2m demo --kind bed --seed 4 --out bed",
        ),
        (
            render("kitchen", "A kitchen, from outside", "kitchen --orbit --frames 4", 2),
            render("kitchen-inside", "The kitchen, inside", "kitchen --tour --frames 8", 4),
            render("bed", "A bedroom, from outside", "bed --orbit --frames 4"),
            render("bed-inside", "The bedroom, inside", "bed --tour --frames 8", 6),
        ),
    ),
    Scene(
        "Generated houses",
        "Furnished houses in various styles: block worlds with exact ground truth.",
        ("w2m rooms generate --houses 4 --seed 21 --worlds houses",),
        (
            render("house-1", "A house of two storeys", "houses/house_0001 --orbit --frames 4"),
            render("house-2", "A house of one storey", "houses/house_0002 --orbit --frames 4"),
            render("room-1", "A bedroom", "houses/house_0001 --tour --frames 8", 5),
            render("room-2", "A bedroom of stone", "houses/house_0002 --tour --frames 8", 5),
            render("room-3", "A living room", "houses/house_0003 --tour --frames 8", 1),
            render("room-4", "A green living room", "houses/house_0004 --tour --frames 8", 6),
        ),
    ),
    Scene(
        "Styles",
        "The same run, built of blocks, of display entities, and of one block per voxel.",
        (
            "w2m build kitchen --out fine --style display --blocks-per-metre 2",
            "w2m build kitchen --out coarse --style blocks --blocks-per-metre 2",
            "w2m build kitchen --out exact --blocks-per-metre 12.5",
        ),
        (
            render("style-blocks", "Blocks, 2 per metre", "coarse --orbit --frames 4", 2),
            render("style-display", "Display entities, 2 per metre", "fine --orbit --frames 4", 2),
            render("style-exact", "One block per voxel", "exact --orbit --frames 4"),
        ),
    ),
    Scene(
        "The paper's figure",
        "Photo, world, predicted cells and construction; below, the views of an agent.",
        ('w2m vln run kitchen "Go to the black cabinet" --out walk --no-video',),
        (
            Shot(
                "figure",
                "The kitchen, and the way of the oracle agent to its black cabinet",
                "w2m paper figure kitchen --walk walk --out figure.png",
                "figure.png",
            ),
        ),
    ),
)
TUTORIAL = Scene(
    "Tutorials",
    "What the commands of the tutorials show; the pages say them.",
    (
        "w2m rooms scan --seed 7 --kind study --out my_scan",
        "w2m reconstruct my_scan --out OUT",
        "w2m build OUT --out NORDIC --palette nordic.yaml",
        'w2m vln run OUT "Go to the table" --out WALK --no-video',
        "w2m dataset build DATA --houses 2 --images 20",
    ),
    (
        Shot("scan", "", "w2m scan my_scan", "my_scan-scan.png"),
        render("room", "", "OUT --tour --frames 8", 3),
        Shot("figure", "", "w2m paper figure OUT --capture my_scan --walk WALK", "figure.png"),
        render("nordic", "", "NORDIC --orbit --frames 4", 2),
        Shot(
            "sample",
            "",
            "w2m dataset show DATA house_0002-r01t000-000000 --picture sample.png",
            "sample.png",
        ),
    ),
)


# The README's picture.


def main() -> None:
    """Make the scenes, draw the pictures, write the page."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        Path("nordic.yaml").write_text(NORDIC, "utf-8")
        for scene, place in (*((one, GALLERY) for one in SCENES), (TUTORIAL, TUTORIALS)):
            for line in scene.make:
                _run(line)
            for shot in scene.shots:
                _run(shot.command)
                write_bytes(DOCS / place / f"{shot.stem}.jpg", small_jpeg(Path(shot.file)))
        _run("w2m demo --kind living --seed 5 --out demo")
        write_bytes(DOCS / "images" / "demo.webp", animated(film(Path("demo"))))
    write_text(DOCS / "gallery.md", page())


def small_jpeg(path: Path) -> bytes:
    """Return a picture as a JPEG that a page loads fast; one that is already is not made worse."""
    if path.suffix == ".jpg":
        return path.read_bytes()
    picture = Image.open(path).convert("RGB")
    picture.thumbnail((WIDEST_PX, WIDEST_PX), Image.Resampling.LANCZOS)
    return _jpeg(picture)


def _jpeg(picture: Image.Image) -> bytes:
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=QUALITY, optimize=True)
    return stream.getvalue()


def page() -> str:
    """Return the page's text."""
    head = (
        "# Gallery\n\nThis page shows generated scenes, drawn with the program's own textures.\n\n"
        f"Each picture has its command; those of `w2m render` also have `{SIZE}`.\n"
    )
    parts = [_section(scene) for scene in SCENES]
    foot = "`python tools/make_gallery.py` writes this page and its pictures.\n"
    return "\n".join([head, *parts, foot])


def _section(scene: Scene) -> str:
    pictures = "\n".join(
        f"<figure markdown>\n![{shot.title}]({GALLERY}/{shot.stem}.jpg)\n"
        f"<figcaption>{shot.title}</figcaption>\n</figure>\n"
        for shot in scene.shots
    )
    shown = (shot.command.replace(f" {SIZE}", "") for shot in scene.shots)
    commands = "\n".join([*scene.make, *shown])
    return (
        f"## {scene.title}\n\n{scene.about}\n\n"
        f'<div class="gallery" markdown>\n\n{pictures}\n</div>\n\n'
        f"<details markdown><summary>Commands</summary>\n\n```\n{commands}\n```\n\n</details>\n"
    )


def _run(line: str) -> None:
    words = shlex.split(line)[1:]
    code = cli.run(words)
    if code != os.EX_OK:
        sys.exit(f"{line} ended with {code}")


if __name__ == "__main__":
    main()
