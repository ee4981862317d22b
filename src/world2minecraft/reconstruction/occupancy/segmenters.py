"""Networks that say what each pixel shows, by name; others join through an entry point.

``hf:MODEL`` is any of the transformers library (``hf_semantics.py``). Packages add families under
the group ``world2minecraft.segmenter``.
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.registry import Registry


class Segmenter(Protocol):
    """A network that is loaded when it is first asked.

    ``identity`` tells this state of it from any other, as ``labels`` does what its labels are.
    """

    name: str
    identity: str
    labels: tuple[str, ...]

    def predict(self, colour: np.ndarray, classes: np.ndarray) -> np.ndarray:
        """Return float32 [h, w, 12]: probabilities of classes, at a size of the network's own.

        Args:
            colour: uint8 [H, W, 3]; rows and columns of the answer spread over all of it.
            classes: float32 [C, 12], what each of its labels means.
        """
        ...


SEGMENTERS = Registry(
    "segmenter",
    {"hf": "world2minecraft.reconstruction.occupancy.hf_segmenter:HuggingFaceSemantics"},
)


def segmenter(name: str) -> Segmenter:
    """Return the network that ``FAMILY:MODEL`` names, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.

    Raises:
        UnknownNameError: no registry holds the family. UsageError: no model is named.
        MissingExtraError: what the family needs is not installed.
        InputError: the model cannot be had or read.
    """
    family, _, model = name.partition(":")
    make: Callable[[str], Segmenter] = SEGMENTERS.load(family)
    if not model:
        raise UsageError(f"a segmenter is FAMILY:MODEL, not {name!r}; type {family}:ORG/NAME")
    return make(model)
