"""The classes of the labels of segmentation models, by their names."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.vocabulary import label_keys


@dataclass(frozen=True, eq=False)
class LabelClasses:
    """The mapping of a model's labels to classes.

    Attributes:
        matrix: Matrix that converts probabilities of C labels to classes, float32 [C, 12]; rows of
            labels without class are 0.
        unknown: Label names that the table does not contain.
    """

    matrix: np.ndarray
    unknown: tuple[str, ...]


def label_classes(names: Sequence[str], table: Mapping[str, int | None]) -> LabelClasses:
    """Map the labels of a model to classes by their names.

    Args:
        names: Labels of the model.
        table: Class of each label, None for labels that vote for nothing;
            ``Vocabulary.label_table`` returns it.

    Example:
        >>> from world2minecraft.core.vocabulary import read_vocabulary
        >>> table = read_vocabulary().label_table()
        >>> found = label_classes(["windowpane, window", "sky-other-merged", "gizmo"], table)
        >>> int(found.matrix[0].argmax()), float(found.matrix[1].sum()), found.unknown
        (4, 0.0, ('gizmo',))
    """
    matrix = np.zeros((len(names), CLASS_COUNT), np.float32)
    unknown = []
    for row, name in enumerate(names):
        known = [key for key in label_keys(name) if key in table]
        if not known:
            unknown.append(name.strip())
        elif (found := table[known[0]]) is not None:
            matrix[row, found] = 1
    return LabelClasses(matrix, tuple(unknown))
