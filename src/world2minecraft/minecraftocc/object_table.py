"""The objects of a scene by the numbers in ``instance``: ``scenes/SCENE.objects.json``.

A row is ``{instance, class, name, name_confidence, nyu40}``. The name is that of the
reconstruction from 0.5 of confidence on, or in generated houses what the furniture design shows;
else it is the display name of the class. ``nyu40`` is the nearest of the 40 classes of NYUv2.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES, display_name
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.vocabulary import MIN_NAME_CONFIDENCE, nyu40_of, read_vocabulary
from world2minecraft.formats.object_names import NamedObject, names_of_rows

MAX_BYTES = 64 << 20


def object_rows(
    volume: BlockVolume,
    designs: tuple[np.ndarray, Sequence[str]],
    names: Iterable[NamedObject] = (),
) -> list[dict[str, Any]]:
    """Return a row for each object of a volume, by instance.

    Args:
        volume: Blocks with classes and instances.
        designs: Design index of each block, uint16 [X, Y, Z], and the names of the designs.
        names: Names of objects that are known.
    """
    codes, design_names = designs
    classes = _most_common(volume.instance, volume.semantic)
    design_of = _most_common(volume.instance, codes)
    known = {one.id: one for one in names}
    vocabulary, rows = read_vocabulary(), []
    for instance, class_id in classes.items():
        if class_id not in OBJECT_CLASSES:
            continue
        named = known.get(instance)
        shown = vocabulary.of_template(design_names[design_of.get(instance, 0)])
        name, confidence = display_name(class_id), 0.0
        if named is not None:
            confidence = named.name_confidence
            name = named.name if confidence >= MIN_NAME_CONFIDENCE else name
        elif shown is not None:
            name, confidence = shown.name, 1.0
        rows.append(
            {
                "instance": instance,
                "class": CLASS_NAMES[class_id],
                "name": name,
                "name_confidence": round(confidence, 4),
                "nyu40": nyu40_of(name, class_id),
            }
        )
    return rows


def read_object_table(path: Path) -> dict[int, NamedObject]:
    """Read the objects of a scene by instance; empty in data sets of former versions.

    Raises:
        DamagedFileError: If the file exists and is not valid.
    """
    if not path.is_file():
        return {}
    rows = read_json(path, MAX_BYTES)
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise DamagedFileError(path, "must contain a list of objects")
    named = names_of_rows([row | {"id": row.get("instance")} for row in rows], path)
    return {one.id: one for one in named}


def _most_common(instance: np.ndarray, values: np.ndarray) -> dict[int, int]:
    """Return the most common value above 0 of each instance above 0, in order of instances."""
    used = (instance > 0) & (values > 0)
    pairs = instance[used].astype(np.int64) << 16 | values[used]
    found, counts = np.unique(pairs, return_counts=True)
    order = np.lexsort((counts, found >> 16))
    return {int(pair >> 16): int(pair & 0xFFFF) for pair in found[order]}
