"""Scores and a picture of the shipped segmentation networks on generated rooms that they never saw.

``python -m benchmarks.draw_segmentation OUT.png [--rooms 18]``

Each row shows one frame: colour, the true classes, and the classes by ``segmentation.onnx`` and by
``segmentation_generated.onnx``. By the pixel accuracy of the first network, the rows are the worst
frame of each of the three worst rooms, and the median frame. Pixels without a class of NYU40 are
black in the truth.
"""

import argparse
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.check_segmentation import print_classes
from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame
from world2minecraft.networks.segmentation.generated import generate_frames
from world2minecraft.networks.segmentation.scores import SegmentationScores, confusion_matrix
from world2minecraft.reconstruction.recognition.label_images import (
    UNKNOWN_ID,
    nyu40_colours,
    write_class_names,
)
from world2minecraft.reconstruction.recognition.segmentation import WEIGHTS, SegmentationModel

FIRST_SEED = 300_000
FRAMES_PER_ROOM = 2
WORST_ROOMS = 3
WIDTH, HEIGHT, GAP, LINE = 240, 180, 4, 18
COLOURS = 128  # Of the picture, to keep the file small.
NETWORKS = ("segmentation.onnx", "segmentation_generated.onnx")
INK, PAPER = (20, 20, 20), (255, 255, 255)


def named_picture(classes: np.ndarray) -> Image.Image:
    """Return an image of classes [H, W], counted from 0, with the name of each large one."""
    ids = np.where(classes == IGNORED, UNKNOWN_ID, classes + 1).astype(np.uint8)
    small = np.asarray(Image.fromarray(ids).resize((WIDTH, HEIGHT), Image.Resampling.NEAREST))
    image = Image.fromarray(nyu40_colours()[small])
    write_class_names(image, small)
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
        for frame, classes in zip(frames, answers, strict=True):
            probability = model.predict(frame.colour, frame.depth_m, frame.camera)
            classes.append(probability.argmax(axis=2).astype(np.uint8))
            one = confusion_matrix(frame.labels, classes[-1])
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
