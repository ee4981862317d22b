"""Destinations of images: one file, a folder or an animation, with the poses beside it."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import OutputError, UsageError
from world2minecraft.core.files import write_bytes, write_json
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.core.types.capture import MAX_SIDE_PX
from world2minecraft.rendering import Picture
from world2minecraft.rendering.output import (
    ANIMATION_SUFFIXES,
    LAYERS,
    FileFormats,
    animation_writer,
    colour_bytes,
    file_name,
    id_names,
)
from world2minecraft.rendering.output.images import COLOUR_SUFFIXES, DEPTH_SUFFIXES
from world2minecraft.rendering.picture import MAX_PIXELS
from world2minecraft.rendering.picture_files.shot_selection import Kind, Medium
from world2minecraft.rendering.views import Shot, tour_line, write_lines

LINES_FILE, NAMES_FILE = "poses.jsonl", "names.json"
RENDERED = FolderKind(
    {LINES_FILE: "camera_to_room"},
    (LINES_FILE, NAMES_FILE, *(f"*{end}" for end in (*COLOUR_SUFFIXES, *DEPTH_SUFFIXES))),
)
_NUMBERS = ("block", "opaque", "state", "class", "instance", "face")


@dataclass(frozen=True)
class Target:
    """The destination of images, and the layers to write."""

    path: Path
    medium: Medium
    layers: tuple[str, ...]
    choice: FileFormats

    def beside(self, name: str) -> Path:
        """Return the path of a side file, in the image folder or beside the image."""
        if self.medium == "folder":
            return self.path / name
        return self.path.with_name(f"{self.path.stem}.{name}")


def choose_target(
    out: Path | None, name: str, kind: Kind, layers: tuple[str, ...], choice: FileFormats,
    frames: int | None,
) -> Target:  # fmt: skip
    """Return the destination of images, chosen by the suffix of ``out``.

    Raises:
        UsageError: If the suffix is unknown, or if its format cannot contain the layers.
        OutputError: If ``out`` is a file but must be a folder, or the other way round.
    """
    if out is None:
        end = {"tour": ".gif", "turntable": ".gif", "poses": "_views"}.get(kind, ".png")
        out = Path(f"{name}{end}")
    suffix = out.suffix.lower()
    many = kind in ("poses", "tour", "turntable") or (frames or 1) > 1
    moving = suffix in ANIMATION_SUFFIXES and (suffix != ".webp" or (many and frames != 1))
    if moving:
        if layers != ("rgb",):
            others = ", ".join(name for name in layers if name != "rgb")
            raise UsageError(f"{out}: an animation can only contain rgb; use a folder for {others}")
        return Target(_file(out), "moving", layers, choice)
    if suffix in COLOUR_SUFFIXES:
        return Target(_file(out), "picture", layers, replace(choice, colour_suffix=suffix))
    if suffix in DEPTH_SUFFIXES:
        wanted = ("depth",) if layers == ("rgb",) else layers
        return Target(_file(out), "picture", wanted, replace(choice, depth_suffix=suffix))
    if suffix and not out.is_dir():
        known = ", ".join(dict.fromkeys((*COLOUR_SUFFIXES, *DEPTH_SUFFIXES, *ANIMATION_SUFFIXES)))
        raise UsageError(
            f"{out}: the output must end in {known}, or have no suffix to write a folder"
        )
    if out.exists() and not out.is_dir():
        raise OutputError(out, "this is a file; choose a folder, or a name such as house.png")
    return Target(out, "folder", layers, choice)


def _file(out: Path) -> Path:
    if out.is_dir():
        raise OutputError(out, "this is a folder; choose another name")
    return out


class Writer:
    """A writer of images as they are rendered, and of their poses at the end."""

    def __init__(self, target: Target, block_to_room: np.ndarray, scene_id: str, tour_id: str):
        """Create a writer that has not written any images yet."""
        self.target, self.lines = target, []
        self._block_to_room, self._ids = block_to_room, {"scene_id": scene_id, "tour_id": tour_id}
        self._moving: Any = None

    @contextmanager
    def open(self, rate_hz: float) -> Iterator[None]:
        """Open an animation for the duration of a ``with`` block. Other formats need no setup."""
        if self.target.medium != "moving":
            yield
            return
        with animation_writer(self.target.path, rate_hz) as self._moving:
            yield

    def later(self, shot: Shot, picture: Picture, volume: BlockVolume) -> Callable[[], None]:
        """Reserve the file names of an image, and return a thread-safe function that writes it."""
        moving, choice = self._moving, self.target.choice
        if moving is not None:
            self._line(shot, {"rgb": self.target.path.name})
            return lambda: moving(picture.colour)
        files = self._files()
        self._line(shot, {name: path.name for name, path in files.items()})

        def write() -> None:
            for name, path in files.items():
                write_bytes(path, LAYERS[name].make(picture, volume, choice))

        return write

    def colour(self, shot: Shot, colour: np.ndarray) -> None:
        """Write an image that only has colour, uint8 [H, W, 3]."""
        if self._moving is not None:
            self._moving(colour)
            self._line(shot, {"rgb": self.target.path.name})
            return
        path, choice = self._files()["rgb"], self.target.choice
        write_bytes(path, colour_bytes(colour, choice.colour_suffix, choice.quality))
        self._line(shot, {"rgb": path.name})

    def finish(self, volume: BlockVolume) -> None:
        """Write the poses, and the meaning of ids if a layer contains ids."""
        write_lines(self.target.beside(LINES_FILE), self.lines)
        if any(name in _NUMBERS for name in self.target.layers):
            write_json(self.target.beside(NAMES_FILE), id_names(volume))

    def _files(self) -> dict[str, Path]:

        target = self.target
        folder, stem = target.path, f"{len(self.lines):06d}"
        if target.medium == "picture":
            folder, stem = target.path.parent, target.path.stem
        names = {name: file_name(stem, name, target.choice) for name in target.layers}
        if target.medium == "picture" and len(names) == 1:
            names = dict.fromkeys(names, target.path.name)  # Named as given.
        return {name: folder / file for name, file in names.items()}

    def _line(self, shot: Shot, files: dict[str, str]) -> None:

        more = {
            **self._ids,
            "image": files.get("rgb", next(iter(files.values()))),
            "files": files,
            "intrinsics": shot.camera.matrix.tolist(),
            "camera_to_room": shot.camera_to_room.round(9).tolist(),
        }
        self.lines.append(tour_line(shot, len(self.lines), self._block_to_room, more))


def check_many(target: Target, count: int) -> None:
    """Check that several images are not written to a single image file.

    Raises:
        UsageError: If there are several images but only one file.
    """
    if target.medium == "picture" and count != 1:
        raise UsageError(
            f"cannot write {count} images to {target.path.name}; choose an output folder, or a "
            "name that ends in .gif, .webp or .mp4"
        )


def check_pixels(cameras: Iterable[Camera], samples: int) -> None:
    """Check the size of an image.

    Raises:
        UsageError: If the image would be too large.
    """
    for width, height in {(camera.width_px, camera.height_px) for camera in cameras}:
        rays = width * height * samples**2
        if rays > MAX_PIXELS or max(width, height) * samples > MAX_SIDE_PX:
            raise UsageError(
                f"{width}x{height} with {samples} x {samples} samples per pixel is too large; the "
                f"limits are {MAX_PIXELS:,} samples in total and {MAX_SIDE_PX:,} pixels per side"
            )


def check_same_size(shots: Iterable[Shot], target: Target) -> None:
    """Check that all frames of an animation have the same size.

    Raises:
        UsageError: If the sizes differ.
    """
    sizes = {(shot.camera.width_px, shot.camera.height_px) for shot in shots}
    if target.medium == "moving" and len(sizes) > 1:
        raise UsageError("the poses have different image sizes; choose an output folder")
