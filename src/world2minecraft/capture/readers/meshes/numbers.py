"""Numbers in text: whole files of them, parsed in one go."""

import warnings

import numpy as np

from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError


def parse_numbers(place: AnyPath, text: bytes) -> np.ndarray:
    """Return all numbers of a text, float64 [N], that white space parts.

    Raises:
        DamagedFileError: something in it is no number.
    """
    if not text.strip():
        return np.zeros(0)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # How numpy says that it stopped early.
            return np.fromstring(text.decode("ascii"), np.float64, sep=" ")
    except (DeprecationWarning, UnicodeDecodeError, ValueError) as error:
        raise DamagedFileError(
            place, "holds what is no number where numbers are due; export it again"
        ) from error
