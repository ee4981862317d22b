"""Format detection for occupancy data sets, and the function that opens them."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from world2minecraft.core.errors import InputError, UnknownNameError
from world2minecraft.minecraftocc.importers.embodied import is_embodied, open_embodied
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.minecraftocc.importers.npz import is_npz, open_npz
from world2minecraft.minecraftocc.importers.nyu import is_nyu, open_nyu
from world2minecraft.minecraftocc.importers.occscannet import is_occscannet, open_occscannet


class FormatReader(NamedTuple):
    """The functions that detect and open a data set format."""

    is_at: Callable[[Path], bool]
    open: Callable[[Path], ImportedSet]


def _is_store(path: Path) -> bool:
    return (path / "dataset.json").is_file()


def _open_store(path: Path) -> ImportedSet:
    """Open a data set in our own format, importing its reader only when needed."""
    from world2minecraft.minecraftocc.store import open_store  # noqa: PLC0415

    store = open_store(path)
    columns = store.index()
    splits = dict(zip(columns["key"].tolist(), columns["split"].tolist(), strict=True))
    return ImportedSet(path, "store", splits, store.sample, sha256=store.sha256)


# In the order in which they are tried: an embodied folder contains an occscannet folder.
IMPORTED: dict[str, FormatReader] = {
    "store": FormatReader(_is_store, _open_store),
    "embodied": FormatReader(is_embodied, open_embodied),
    "nyu": FormatReader(is_nyu, open_nyu),
    "occscannet": FormatReader(is_occscannet, open_occscannet),
    "npz": FormatReader(is_npz, open_npz),
}


def open_occupancy(
    path: str | Path, format: str | None = None, *, labels: str | Path | None = None
) -> ImportedSet:
    """Open an occupancy data set in our own format or in one of the published formats.

    Args:
        path: Folder in one of the formats. A single ``.bin`` or ``.npz`` file is also accepted.
        format: ``store`` (our own format), ``nyu``, ``occscannet``, ``embodied`` or ``npz``.
            Detected automatically by default.
        labels: Folder with MonoScene's preprocessed ``base/``, if it is stored elsewhere. Only for
            ``nyu``.

    Raises:
        UnknownNameError: If the format is unknown.
        InputError: If the folder is not in any of the formats, or is empty.
    """
    place = Path(path)
    if not place.exists():
        raise InputError(place, "not found")
    if format is None:
        format = next((name for name, kind in IMPORTED.items() if kind.is_at(place)), None)
        if format is None:
            raise InputError(
                place,
                "not an occupancy data set: no dataset.json, NYUtrain/, gathered_data/, "
                "scene_occ/ or "
                "train/KEY.npz found",
            )
    if format not in IMPORTED:
        raise UnknownNameError("format", format, IMPORTED)
    if format == "nyu":
        return open_nyu(place, None if labels is None else Path(labels))
    return IMPORTED[format].open(place)
