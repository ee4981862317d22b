"""Fit the NIQE model that is shipped, from the free photographs of two Python packages.

    pip install scikit-image scikit-learn
    python tools/make_niqe_model.py            writes metrics/image_quality/data/niqe_own.json

Numbers are rounded to eight digits, so that the file is the same on every machine.
"""

import json
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.capture.images import read_colour
from world2minecraft.core.files import write_text
from world2minecraft.evaluation.metrics.image_quality.niqe import OWN, OWN_FILE, SHARP, fit_niqe


class Photo(NamedTuple):
    """A photograph, where it lies, whose it is."""

    package: str
    file: str
    source: str
    licence: str


SKIMAGE, SKLEARN = "skimage/data", "sklearn/datasets/images"
PHOTOS = (
    Photo(SKIMAGE, "astronaut.png", "NASA Great Images", "public domain"),
    Photo(SKIMAGE, "brick.png", "CC0Textures, Bricks25", "CC0"),
    Photo(SKIMAGE, "camera.png", "Lav Varshney", "CC0"),
    Photo(SKIMAGE, "chelsea.png", "Stefan van der Walt", "CC0"),
    Photo(SKIMAGE, "coffee.png", "Rachel Michetti, Pikolo Espresso Bar", "CC0"),
    Photo(SKIMAGE, "coins.png", "Brooklyn Museum Collection", "no known copyright restrictions"),
    Photo(SKIMAGE, "grass.png", "linolafett, DeviantArt", "CC0"),
    Photo(SKIMAGE, "gravel.png", "CC0Textures, Gravel04", "CC0"),
    Photo(SKIMAGE, "rocket.jpg", "SpaceX", "public domain"),
    Photo(SKLEARN, "china.jpg", "danielbuechele, Flickr 6061409035", "CC BY 2.0"),
    Photo(SKLEARN, "flower.jpg", "vultilion, Flickr 6056698931", "CC BY 2.0"),
)


def place_of(photo: Photo) -> Path | None:
    """Find a photo without importing its package; None where that is not installed."""
    package, _, rest = photo.package.partition("/")
    found = find_spec(package)
    return Path(str(found.origin)).parent / rest / photo.file if found else None


def fitted(photos: tuple[Photo, ...] = PHOTOS) -> dict[str, Any]:
    """Return what the file holds."""
    places = [place for photo in photos if (place := place_of(photo)) is not None]
    model = fit_niqe((read_colour(place) for place in places), OWN)
    return {
        "about": "NIQE (Mittal et al., 2013), fitted by tools/make_niqe_model.py",
        "covariance": [[_rounded(value) for value in row] for row in model.covariance],
        "mean": [_rounded(value) for value in model.mean],
        "photos": [photo._asdict() for photo in photos],
        "sharp": SHARP,
    }


def _rounded(value: np.float64) -> float:
    return float(f"{value:.8g}")


def main() -> None:
    """Write the file."""
    missing = sorted({photo.package for photo in PHOTOS if place_of(photo) is None})
    if missing:
        sys.exit(f"{', '.join(missing)} is not there; pip install scikit-image scikit-learn")
    lines = [f" {json.dumps(key)}: {_wrapped(value)}" for key, value in sorted(fitted().items())]
    write_text(OWN_FILE, "{\n" + ",\n".join(lines) + "\n}\n")


def _wrapped(value: Any) -> str:
    """Return JSON with one row of a table a line, so that it can be looked at."""
    if not isinstance(value, list) or not isinstance(value[0], list | dict):
        return json.dumps(value)
    return "[\n  " + ",\n  ".join(json.dumps(row) for row in value) + "\n ]"


if __name__ == "__main__":
    main()
