"""The pictures of a data set, or of any folder, by their keys."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import SUFFIXES, read_colour, read_header
from world2minecraft.core.errors import InputError
from world2minecraft.minecraftocc.store import OccStore, open_store
from world2minecraft.minecraftocc.store.folder import META


@dataclass(frozen=True)
class PictureSource:
    """Pictures to be read one at a time."""

    name: str
    keys: tuple[str, ...]
    read: Callable[[str], np.ndarray]  # returns uint8 [H, W, 3]
    is_picture: Callable[[str], bool] | None = None  # Where some keys may be none.


def pictures_at(path: str | Path) -> PictureSource:
    """Return the pictures of a stored data set or of a folder, its subfolders too.

    Raises:
        InputError: there are none. DamagedFileError: the data set is damaged.
    """
    place = Path(path)
    if (place / META).is_file():
        return _of_store(open_store(place))
    return _of_folder(place)


def _of_store(store: OccStore) -> PictureSource:
    def read(key: str) -> np.ndarray:
        colour = store[key].colour
        if colour is None:
            raise InputError(store.folder, f"sample {key} has labels alone, no picture")
        return colour

    return PictureSource(store.folder.resolve().name, tuple(store.keys()), read)


def _of_folder(folder: Path) -> PictureSource:
    if not folder.is_dir():
        raise InputError(folder, "is no folder of pictures and no data set")
    found = sorted(
        place.relative_to(folder).as_posix()
        for place in folder.rglob("*")
        if place.suffix.lower() in SUFFIXES and place.is_file()
    )
    if not found:
        raise InputError(folder, f"holds no pictures ({', '.join(SUFFIXES)})")

    def is_picture(key: str) -> bool:
        return not read_header(folder / key).mode.startswith(("I", "F"))  # Depth and the like.

    def read(key: str) -> np.ndarray:
        return read_colour(folder / key)

    return PictureSource(folder.resolve().name, tuple(found), read, is_picture)
