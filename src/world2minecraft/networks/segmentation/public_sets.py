"""Readers of public data sets with labelled frames: the original NYUv2 file and SUN RGB-D.

Neither is part of the project. Their licences allow research; see the pages of the data sets.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.depth_images import DepthEncoding
from world2minecraft.capture.images import read_raw
from world2minecraft.capture.readers.datasets.intrinsics import matrix_camera
from world2minecraft.capture.readers.datasets.text_tables import read_matrix
from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.networks.segmentation.frames import (
    IGNORED,
    NYU_CAMERA,
    LabelledFrame,
    Part,
    labelled_frame,
    nyu_part,
)

CLASS_MAPPING = "classMapping40.mat"
MAPPING_KEY, MAPPING_COUNT = "mapClass", 894
SUN_LABELS, SUN_DEPTH, SUN_CAMERA = "seg.mat", "depth_bfx", "intrinsics.txt"
# Names that SUN RGB-D's annotators used for classes of NYU40.
SYNONYMS = {
    "couch": "sofa",
    "cupboard": "cabinet",
    "drawer": "dresser",
    "fridge": "refrigerator",
    "nightstand": "night stand",
    "tv": "television",
    "monitor": "television",
    "rug": "floor mat",
    "carpet": "floor mat",
    "shelf": "shelves",
    "painting": "picture",
    "cloth": "clothes",
}


def read_nyu_mat(path: Path, parts: Sequence[Part]) -> list[LabelledFrame]:
    """Read frames of ``nyu_depth_v2_labeled.mat``, whose numbers count from 1.

    Args:
        path: The file, which is HDF5. Beside it must be ``classMapping40.mat``, the published map
            from its 894 classes to 40.
        parts: Parts of the project's split to read.

    Raises:
        UsageError: If h5py is not installed.
        InputError: If a file is missing or is not what its name says.
    """
    try:
        import h5py  # type: ignore  # noqa: PLC0415  # Nothing else needs it.
    except ModuleNotFoundError as error:
        raise UsageError(f"{path.name} is HDF5; to read it: pip install h5py") from error
    classes = read_class_mapping(path.parent / CLASS_MAPPING)
    try:
        with h5py.File(path, "r") as file:
            return list(frames_of_nyu_arrays(file, classes, parts))
    except (OSError, KeyError) as error:
        raise DamagedFileError(path, f"is not NYUv2's labelled set: {error}") from error


def read_class_mapping(path: Path) -> np.ndarray:
    """Read ``classMapping40.mat``: the NYU40 id of each of the 894 classes, uint8 [895].

    Raises:
        InputError: If the file is missing or is not what its name says.
    """
    found = _read_mat(path).get(MAPPING_KEY)
    values = np.asarray(0 if found is None else found).reshape(-1)
    if len(values) != MAPPING_COUNT:
        raise DamagedFileError(
            path, f"must contain {MAPPING_KEY} with {MAPPING_COUNT} numbers, one for each class"
        )
    return np.concatenate([[0], values]).astype(np.uint8)


def frames_of_nyu_arrays(
    arrays: Mapping[str, Any], classes: np.ndarray, parts: Sequence[Part]
) -> Iterator[LabelledFrame]:
    """Yield frames from the arrays of the labelled set.

    Args:
        arrays: ``images`` [N, 3, W, H], ``depths`` [N, W, H] in metres and ``labels`` [N, W, H],
            with the axes as HDF5 gives them.
        classes: NYU40 id of each class, uint8 [895], 0 where there is none.
        parts: Parts of the split to read.
    """
    for index in range(len(arrays["labels"])):
        if nyu_part(index + 1) not in parts:
            continue
        labels = _to_labels(classes[np.asarray(arrays["labels"][index]).T])
        colour = np.ascontiguousarray(np.asarray(arrays["images"][index]).T)
        depth_m = np.asarray(arrays["depths"][index], np.float32).T
        camera = NYU_CAMERA.scaled_to(colour.shape[1], colour.shape[0])
        yield labelled_frame(f"{index + 1:04}", colour, labels, depth_m, camera)


def read_sun_rgbd(folder: Path) -> LabelledFrame:
    """Read a frame folder of SUN RGB-D, with its labels in ``seg.mat``.

    Raises:
        InputError: If a file is missing or cannot be read.
    """
    colour = np.array(Image.open(_only_file(folder / "image")).convert("RGB"))
    depth_m = DepthEncoding("rotated").to_metres(read_raw(_only_file(folder / SUN_DEPTH)))
    size = (colour.shape[1], colour.shape[0])
    matrix = read_matrix(folder / SUN_CAMERA, [(3, 3), (4, 4)])
    camera = matrix_camera(folder / SUN_CAMERA, size, matrix)
    return labelled_frame(folder.name, colour, _sun_labels(folder, size), depth_m, camera)


def find_sun_rgbd(folder: Path) -> list[Path]:
    """Return the labelled frame folders of SUN RGB-D in and below a folder.

    Raises:
        InputError: If there are none.
    """
    found = sorted(path.parent for path in folder.rglob(SUN_LABELS))
    if not found:
        raise InputError(
            folder, f"contains no frame folders of SUN RGB-D with labels ({SUN_LABELS})"
        )
    return found


def sun_class(name: str) -> int:
    """Return the NYU40 id of a name of SUN RGB-D's annotators, 0 if it is none.

    Example:
        >>> sun_class("night_stand"), sun_class("Couch"), sun_class("thing")
        (32, 6, 0)
    """
    words = name.replace("_", " ").strip().lower()
    return nyu40_names().get(SYNONYMS.get(words, words), 0)


def _sun_labels(folder: Path, size: tuple[int, int]) -> np.ndarray:
    path = folder / SUN_LABELS
    held = _read_mat(path)
    if not {"seglabel", "names"} <= set(held):
        raise DamagedFileError(path, "must contain the variables seglabel and names")
    names = [str(np.asarray(one).reshape(-1)[0]) for one in np.asarray(held["names"]).reshape(-1)]
    classes = np.array([0, *(sun_class(name) for name in names)], np.uint8)
    stored = np.asarray(held["seglabel"]).astype(np.int64)  # MATLAB keeps doubles.
    if stored.shape != (size[1], size[0]) or stored.max(initial=0) >= len(classes):
        raise DamagedFileError(path, "has another size than the image, or labels without a name")
    return _to_labels(classes[stored])


def _to_labels(ids: np.ndarray) -> np.ndarray:
    """Convert NYU40 ids, 0 where unknown, to labels of frames."""
    return np.ascontiguousarray(np.where((ids > 0) & (ids <= IGNORED), ids - 1, IGNORED), np.uint8)


def _only_file(folder: Path) -> Path:
    files = sorted(path for path in folder.glob("*") if path.is_file())
    if len(files) != 1:
        raise InputError(folder, f"must contain one image, got {len(files)}")
    return files[0]


def _read_mat(path: Path) -> dict[str, Any]:
    """Read a MATLAB file of version 7 or older."""
    from scipy.io import loadmat  # noqa: PLC0415

    if not path.is_file():
        raise InputError(path, "not found; it is published with the data set")
    load: Callable[[str], dict[str, Any]] = loadmat
    try:
        return load(str(path))
    except (ValueError, NotImplementedError, OSError) as error:
        raise DamagedFileError(path, f"is not a MATLAB file: {error}") from error
