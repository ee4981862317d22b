"""Pictures of what the completion network does: ``python -m benchmarks.draw_completion --out PNG``.

Of the scans of ``check_completion`` the best, the middle and the worst by mIoU of all cells are
drawn, and the worst single picture: what was fused, what ``geometric`` and ``completion`` say, and
the truth, from above without the ceiling, a colour a class.
"""

import argparse
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from benchmarks.check_completion import FIRST_SEED, SEEDS_APART, answers, samples_of
from world2minecraft.classes import CLASS_COLOURS, CLASS_NAMES, UNKNOWN
from world2minecraft.coordinates import look_at
from world2minecraft.label.completion_net import CompletionModel
from world2minecraft.learn.completion.samples import Sample
from world2minecraft.metrics.occupancy import count_occupancy
from world2minecraft.render.voxels import cast_voxels
from world2minecraft.types import Camera

SIDE = 360
COLUMNS = ("surface", "geometric", "completion", "truth")
TITLES = ("what was fused", "geometric", "completion", "truth")
SHADES = np.array([0.72, 0.72, 0.84, 0.84, 0.6, 1.0])  # Of the faces -x +x -y +y -z +z.
PAPER = 244


def drawn(labels: np.ndarray) -> Image.Image:
    """Return a picture of labels uint8 [X, Y, Z] from above, without the ceiling."""
    shown = np.where((labels == 1) | (labels == UNKNOWN), np.uint8(0), labels)
    size = np.array(shown.shape) * 0.08
    target = size * [0.5, 0.5, 0.3]
    eye = target + np.array([0.55, -0.9, 1.25]) * 1.25 * size.max()
    camera = Camera(SIDE, SIDE, 1.5 * SIDE, 1.5 * SIDE, SIDE / 2, SIDE / 2)
    hits = cast_voxels(shown, camera, look_at(eye, target), voxel_m=0.08)
    there = hits.voxel_index >= 0
    picture = np.full((SIDE, SIDE, 3), PAPER, np.float64)
    kinds = shown.reshape(-1)[hits.voxel_index[there]]
    picture[there] = np.array(CLASS_COLOURS)[kinds] * SHADES[hits.face[there]][:, None]
    return Image.fromarray(picture.round().astype(np.uint8))


def scored(sample: Sample, model: CompletionModel) -> tuple[float, float, dict[str, np.ndarray]]:
    """Return mIoU of the classes present, IoU, and what each says; walls cut at the ceiling."""
    said = answers(sample, model)
    counts = count_occupancy(said["completion"], sample.truth)
    present = np.unique(sample.truth[(sample.truth > 0) & (sample.truth != UNKNOWN)])
    miou = float(np.mean([counts.class_iou[kind] for kind in present]))
    known = sample.truth != UNKNOWN
    shown = {name: np.where(known, labels, np.uint8(0)) for name, labels in said.items()} | {
        "truth": sample.truth
    }
    return miou, counts.iou, shown


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--rooms", type=int, default=6)
    parser.add_argument("--weights", type=Path)
    parser.add_argument("--keep", type=Path, help="the folder of check_completion's scans")
    chosen = parser.parse_args()
    model, found = CompletionModel(chosen.weights), []
    for number in range(3):
        first = FIRST_SEED + SEEDS_APART * number
        for seed in range(first, first + chosen.rooms):
            for sample in samples_of(seed, chosen.keep):
                if sample.sight.hint is not None:
                    found.append((sample.kind, seed, *scored(sample, model)))
    several = sorted((row for row in found if row[0] != "single"), key=lambda row: row[2])
    single = sorted((row for row in found if row[0] == "single"), key=lambda row: row[2])
    rows = [several[-1], several[len(several) // 2], several[0], single[len(single) // 2]]
    names = ("the best of several pictures", "the middle", "the worst", "one picture, the middle")
    sheet = Image.new("RGB", (SIDE * 4, (SIDE + 20) * 4 + 44), (PAPER,) * 3)
    pen = ImageDraw.Draw(sheet)
    for column, title in enumerate(TITLES):
        pen.text((SIDE * column + 10, 4), title, fill=(40, 40, 40), font_size=15)
    for row, (name, (_, seed, miou, iou, shown)) in enumerate(zip(names, rows, strict=True)):
        top = 24 + row * (SIDE + 20)
        for column, who in enumerate(COLUMNS):
            sheet.paste(drawn(shown[who]), (SIDE * column, top + 20))
        told = (
            f"{name}: seed {seed}, IoU {100 * iou:.0f}, mIoU of the classes there {100 * miou:.0f}"
        )
        pen.text((10, top + 4), told, fill=(90, 90, 90), font_size=13)
    for kind, label in enumerate(CLASS_NAMES[1:], 1):
        left = 10 + (kind - 1) * 125
        pen.rectangle((left, sheet.height - 18, left + 12, sheet.height - 6), CLASS_COLOURS[kind])
        pen.text((left + 18, sheet.height - 20), label, fill=(60, 60, 60), font_size=13)
    sheet.save(chosen.out)
    print(f"{chosen.out}: {len(found)} scans looked at")


if __name__ == "__main__":
    main()
