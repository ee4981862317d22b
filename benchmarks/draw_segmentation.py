"""Scores and a picture of the shipped segmentation networks on generated rooms that they never saw.

``python -m benchmarks.draw_segmentation OUT.png [--rooms 18]``

Each row shows one frame: colour, the true classes, and the classes by ``segmentation.onnx`` and by
``segmentation_generated.onnx``. By the pixel accuracy of the first network, the rows are the worst
frame of each of the three worst rooms, and the median frame. Pixels without a class of NYU40 are
black in the truth.
"""

import argparse
import colorsys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.check_segmentation import print_classes
from world2minecraft.capture.readers.datasets.nyu40_labels import nyu40_names
from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame
from world2minecraft.networks.segmentation.generated import generate_frames
from world2minecraft.networks.segmentation.scores import SegmentationScores, confusion_matrix
from world2minecraft.reconstruction.recognition.segmentation import WEIGHTS, SegmentationModel

FIRST_SEED = 300_000
FRAMES_PER_ROOM = 2
WORST_ROOMS = 3
WIDTH, HEIGHT, GAP, LINE = 240, 180, 4, 18
NAMED_PX = 500  # Smaller classes are not named in the picture.
COLOURS = 128  # Of the picture, to keep the file small.
NETWORKS = ("segmentation.onnx", "segmentation_generated.onnx")
INK, PAPER = (20, 20, 20), (255, 255, 255)


def class_colours() -> np.ndarray:
    """Return a colour for each class, uint8 [40, 3]; black for the ignored one."""
    made = []
    for number in range(IGNORED + 1):
        hue, light = number * 0.381966 % 1, (0.45, 0.6, 0.75)[number % 3]
        made.append(colorsys.hls_to_rgb(hue, light, 0.55))
    made[IGNORED] = (0, 0, 0)
    return np.round(np.array(made) * 255).astype(np.uint8)


def named_picture(classes: np.ndarray) -> Image.Image:
    """Return an image of classes [H, W] with the name of each large one near its middle."""
    image = Image.fromarray(class_colours()[classes]).resize((WIDTH, HEIGHT), 0)
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(11)
    small = np.asarray(Image.fromarray(classes).resize((WIDTH, HEIGHT), 0))
    for name, number in nyu40_names().items():
        rows, columns = np.nonzero(small == number - 1)
        if number - 1 == IGNORED or len(rows) < NAMED_PX:
            continue
        middle = np.array([np.median(columns), np.median(rows)])
        nearest = np.argmin(np.hypot(columns - middle[0], rows - middle[1]))
        place = (
            float(np.clip(columns[nearest], 3 * len(name) + 2, WIDTH - 3 * len(name) - 2)),
            float(rows[nearest]),
        )
        draw.text(place, name, INK, font, anchor="mm")
    return image


def row_of(frame: LabelledFrame, answers: list[np.ndarray]) -> list[Image.Image]:
    """Return the images of one row."""
    colour = Image.fromarray(frame.colour).resize((WIDTH, HEIGHT), Image.Resampling.BOX)
    return [colour, named_picture(frame.labels), *map(named_picture, answers)]


def picked_frames(accuracy: list[float]) -> list[int]:
    """Return the worst frame of each of the three worst rooms, and the median frame."""
    order = [int(n) for n in np.argsort(accuracy, kind="stable")]
    worst: dict[int, int] = {}
    for number in order:
        worst.setdefault(number // FRAMES_PER_ROOM, number)
    return [*list(worst.values())[:WORST_ROOMS], order[len(order) // 2]]


def write_picture(path: Path, rows: list[list[Image.Image]]) -> None:
    """Write rows of images below the titles of their columns."""
    titles = ("colour", "truth", *NETWORKS)
    size = (len(titles) * (WIDTH + GAP) - GAP, LINE + len(rows) * (HEIGHT + GAP) - GAP)
    page = Image.new("RGB", size, PAPER)
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(12)
    for column, title in enumerate(titles):
        draw.text((column * (WIDTH + GAP) + 2, 1), title, INK, font)
        for number, row in enumerate(rows):
            page.paste(row[column], (column * (WIDTH + GAP), LINE + number * (HEIGHT + GAP)))
    page.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def main() -> None:
    """Predict, print the scores, draw."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--rooms", type=int, default=18)
    parser.add_argument("--classes", action="store_true", help="print IoU and recall of each class")
    chosen = parser.parse_args()
    frames = list(generate_frames(range(FIRST_SEED, FIRST_SEED + chosen.rooms), FRAMES_PER_ROOM))
    answers: list[list[np.ndarray]] = [[] for _ in frames]
    accuracy = []
    for name in NETWORKS:
        model = SegmentationModel(WEIGHTS.with_name(name))
        confusion = np.zeros((IGNORED + 1, IGNORED + 1), np.int64)
        for frame, told in zip(frames, answers, strict=True):
            probability = model.predict(frame.colour, frame.depth_m, frame.camera)
            told.append(probability.argmax(axis=2).astype(np.uint8))
            one = confusion_matrix(frame.labels, told[-1])
            confusion += one
            if name == NETWORKS[0]:
                accuracy.append(SegmentationScores(one).pixel_accuracy)
        scores = SegmentationScores(confusion)
        print(f"{name}: {len(frames)} frames of {chosen.rooms} rooms: {scores}")
        if chosen.classes:
            print_classes(scores)
    picked = picked_frames(accuracy)
    write_picture(chosen.out, [row_of(frames[n], answers[n]) for n in picked])
    print([f"{frames[n].name}: {accuracy[n]:.2f}" for n in picked])


if __name__ == "__main__":
    main()
