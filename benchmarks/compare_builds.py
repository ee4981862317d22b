"""Two reconstructions of one capture side by side, as one picture.

``python -m benchmarks.compare_builds BEFORE_OUT AFTER_OUT --out pair.png [--views 6]``

The first row has both previews, each with its figures below. Each further row has a photo and both
worlds from the pose of the photo, for views that both reports contain.
"""

import argparse
import base64
import re
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from rich.console import Console

from world2minecraft.core.files import read_json, write_bytes
from world2minecraft.evaluation.report.comparison_pictures import as_png
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.rendering.preview import preview

PREVIEW_PX = (960, 720)
GAP_PX, CAPTION_PX = 12, 46
PHOTO, BUILT = "Photo ", "The built world at the pose of "
PICTURE = re.compile(r'<img[^>]*src="data:image/\w+;base64,([^"]+)"[^>]*alt="([^"]*)"')
INK, PAPER = (30, 33, 37), (255, 255, 255)


def figures_of(out: Path) -> str:
    """Return the figures of a run's ``report.json`` in a line; none where it has no report."""
    path = out / "report.json"
    if not path.is_file():
        return "no report"
    facts = read_json(path)
    layout, own = facts["layout"], facts["built"]["own_cells"]
    explained = facts["surface_explained"]["within_one_voxel"]
    return (
        f"{facts['blocks']} blocks, {len(facts['objects'])} objects, {100 * own:.0f} % from own "
        f"cells, {layout['collisions']} collisions, {layout['out_of_bounds']} out of bounds, "
        f"{layout['floaters']} floaters, {100 * explained:.0f} % of the surface in a block"
    )


def captioned(image: np.ndarray, text: str) -> Image.Image:
    """Return a picture uint8 [H, W, 3] over a line of text."""
    height, width, _ = image.shape
    page = Image.new("RGB", (width, height + CAPTION_PX), PAPER)
    page.paste(Image.fromarray(image), (0, 0))
    font = ImageFont.load_default(15)
    ImageDraw.Draw(page).text((6, height + 10), text, INK, font)
    return page


def in_rows(rows: list[list[Image.Image]]) -> np.ndarray:
    """Return rows of pictures on one page, uint8 [H, W, 3]; each row begins at the left."""
    width = max(sum(one.width + GAP_PX for one in row) + GAP_PX for row in rows)
    height = sum(max(one.height for one in row) + GAP_PX for row in rows) + GAP_PX
    page = Image.new("RGB", (width, height), PAPER)
    top = GAP_PX
    for row in rows:
        left = GAP_PX
        for one in row:
            page.paste(one, (left, top))
            left += one.width + GAP_PX
        top += max(one.height for one in row) + GAP_PX
    return np.asarray(page)


def pictures_of(out: Path) -> dict[str, Image.Image]:
    """Return the pictures of a run's ``report.html`` by what they show; none without one."""
    path = out / "report.html"
    if not path.is_file():
        return {}
    found = PICTURE.findall(path.read_text("utf-8"))
    return {alt: Image.open(BytesIO(base64.b64decode(data))) for data, alt in found}


def view_rows(before: Path, after: Path, count: int) -> list[list[Image.Image]]:
    """Return rows of a photo and both worlds from its pose, for views that both reports show."""
    shown = [pictures_of(before), pictures_of(after)]
    names = [alt.removeprefix(PHOTO) for alt in shown[1] if alt.startswith(PHOTO)]
    rows = []
    for name in [one for one in names if all(BUILT + one in held for held in shown)][:count]:
        pictures = [shown[1][PHOTO + name], *(held[BUILT + name] for held in shown)]
        texts = [f"photo {name}", "before", "after"]
        rows.append(
            [
                captioned(np.asarray(picture.convert("RGB")), text)
                for picture, text in zip(pictures, texts, strict=True)
            ]
        )
    return rows


def compare(before: Path, after: Path, count: int) -> np.ndarray:
    """Return the page, uint8 [H, W, 3]."""
    first = [
        captioned(preview(read_built(out / "build"), *PREVIEW_PX), f"{name}: {figures_of(out)}")
        for name, out in (("before", before), ("after", after))
    ]
    return in_rows([first, *view_rows(before, after, count)])


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--views", type=int, default=6)
    chosen = parser.parse_args()
    page = compare(chosen.before, chosen.after, chosen.views)
    write_bytes(chosen.out, as_png(page))
    Console().print(f"{chosen.out}: {page.shape[1]} x {page.shape[0]} pixels")


if __name__ == "__main__":
    main()
