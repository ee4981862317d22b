"""Scores of a segmentation network on the validation frames of NYUv2.

``python -m benchmarks.check_segmentation FILE.onnx --nyu FOLDER [--inputs both|colour|depth]
[--classes]``

Printed are pixel accuracy and mIoU of the 40 classes and of the paper's eleven, the expected
calibration error over 15 bins, and the CPU time of a frame. ``--classes`` adds the IoU and the
recall of each class, ``--gate`` the share of pixels above a probability and how many are right.
"""

import argparse
import time
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.vocabulary import NYU40_COUNT, nyu40_names
from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame, read_nyu_folder
from world2minecraft.networks.segmentation.scores import (
    SegmentationScores,
    calibration_error,
    confusion_matrix,
)
from world2minecraft.reconstruction.recognition.segmentation import SegmentationModel

GATES = (0.5, 0.6, 0.7, 0.8, 0.9)


def predicted(model: SegmentationModel, frame: LabelledFrame, inputs: str) -> np.ndarray:
    """Return the probabilities of a frame, float32 [h, w, 40]."""
    return model.predict(
        None if inputs == "depth" else frame.colour,
        None if inputs == "colour" else frame.depth_m,
        frame.camera,
    )


def at_labels(values: np.ndarray, frame: LabelledFrame) -> np.ndarray:
    """Return values [h, w] at the pixels of the labels."""
    height, width = frame.labels.shape
    return np.asarray(Image.fromarray(values).resize((width, height), Image.Resampling.NEAREST))


def print_classes(scores: SegmentationScores) -> None:
    """Print IoU and recall of each class that occurs."""
    recall = np.diag(scores.confusion) / np.maximum(scores.confusion.sum(axis=1), 1)
    for name, number in nyu40_names().items():
        if scores.confusion[number - 1].any():
            print(f"{name:16} {scores.iou[number - 1]:.3f} {recall[number - 1]:.3f}")


def main() -> None:
    """Score and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("weights", type=Path)
    parser.add_argument("--nyu", type=Path, required=True)
    parser.add_argument("--cache", type=Path, help="folder that keeps the smoothed depth")
    parser.add_argument("--inputs", default="both", choices=("both", "colour", "depth"))
    parser.add_argument("--classes", action="store_true")
    parser.add_argument("--gate", action="store_true")
    chosen = parser.parse_args()
    model = SegmentationModel(chosen.weights)
    confusion = np.zeros((NYU40_COUNT, NYU40_COUNT), np.int64)
    sure, right, spent = [], [], 0.0
    frames = read_nyu_folder(chosen.nyu, ["validation"], chosen.cache)
    predicted(model, frames[0], chosen.inputs)  # Reads the weights and compiles kernels.
    for frame in frames:
        start = time.process_time()
        probability = predicted(model, frame, chosen.inputs)
        spent += time.process_time() - start
        classes = at_labels(probability.argmax(axis=2).astype(np.uint8), frame)
        confidence = at_labels(probability.max(axis=2), frame)
        confusion += confusion_matrix(frame.labels, classes)
        seen = frame.labels != IGNORED
        sure.append(confidence[seen])
        right.append((classes == frame.labels)[seen])
    scores = SegmentationScores(confusion)
    confidence, is_right = np.concatenate(sure), np.concatenate(right)
    error = calibration_error(confidence, is_right)
    print(f"{chosen.inputs}: {scores} ECE {error:.3f} CPU s {spent / len(frames):.3f}")
    if chosen.classes:
        print_classes(scores)
    for gate in GATES if chosen.gate else ():
        above = confidence >= gate
        print(f"above {gate}: {above.mean():.3f} of the pixels, {is_right[above].mean():.3f} right")


if __name__ == "__main__":
    main()
