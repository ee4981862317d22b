"""Names of textures become ``Texture`` values: read, cut, squared, joined, with labPBR maps."""

import re
from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.rendering.resource_packs.joining import joined
from world2minecraft.rendering.resource_packs.json_checks import mapping, resource
from world2minecraft.rendering.resource_packs.lab_pbr import material_maps, normal_map
from world2minecraft.rendering.resource_packs.layering import OVER, TIMES
from world2minecraft.rendering.resource_packs.pixels import (
    decode_png,
    first_frame,
    png_size,
    resampled,
    side_for,
)
from world2minecraft.rendering.resource_packs.resources import Resources
from world2minecraft.rendering.texture import Texture

MOST_PNG_BYTES = 32 << 20
MOST_TEXTURES = 8192  # Of one run; the game has about 1,500 of blocks.
LEAST_PX, LARGEST_PX = 16, 128  # The sides that the renderer's textures have.
SAMPLE = 100  # How many textures are looked at for their usual size.
CLEAR = "~clear"  # Ends the name of a texture that a block of clear stuff uses.
_CLEAR_WORDS = re.compile(r"glass|(?<![a-z])ice(?![a-z])|slime|honey_block|water|portal|jelly")
# A texture of clear stuff mixes with what is behind it where this share is neither hole nor solid.
LEAST_CLEAR_SHARE = 0.15
HOLE, SOLID = 13, 242  # Of alpha: what is nearly a hole or nearly solid counts as it.


def is_clear(name: str) -> bool:
    """Return whether a block's or texture's name says that one sees through its stuff."""
    return _CLEAR_WORDS.search(name) is not None


def _power(value: int) -> int:
    """Return the least power of two that is not smaller."""
    return 1 << max(value - 1, 0).bit_length()


class PackTextures:
    """The textures of a stack of packs, each read once."""

    def __init__(self, resources: Resources, most_px: int):
        self._resources, self._most_px = resources, most_px
        self._read: dict[str, Texture | None] = {}

    def get(self, name: str) -> Texture | None:
        """Return the texture of a name that a model of these packs uses, or None."""
        if name not in self._read:
            if len(self._read) >= MOST_TEXTURES:
                self._resources.note(f"more than {MOST_TEXTURES:,} textures; the rest is left out")
                return None
            parts = name.split(OVER)
            self._read[name] = self._one(name) if len(parts) == 1 else self._joined(parts)
        return self._read[name]

    def usual_px(self) -> int:
        """Return the side that most textures of blocks have, by a sample: 16, 32, 64 or 128."""
        names = self._resources.pictures()
        sides: Counter[int] = Counter()
        for name in names[:: max(1, len(names) // SAMPLE)]:
            for _, data in self._resources.versions(name, MOST_PNG_BYTES):
                try:
                    sides[min(max(_power(png_size(data)[0]), LEAST_PX), LARGEST_PX)] += 1
                except ValueError:
                    continue  # It is said where it is used.
                break
        return max(sides, key=lambda side: (sides[side], side), default=LEAST_PX)

    def map_colour(self, name: str, column: int, row: int) -> tuple[int, int, int] | None:
        """Return a pixel of a colour map of 256 x 256 px; None where no pack has that map."""
        file = f"assets/minecraft/textures/colormap/{name}.png"
        for where, data in self._resources.versions(file, MOST_PNG_BYTES):
            try:
                pixels = decode_png(data)
            except ValueError as error:
                self._resources.note(f"{where}: {error}")
                continue
            if pixels.shape[:2] == (256, 256):
                red, green, blue, _ = pixels[row, column].tolist()
                return red, green, blue
        return None

    def _one(self, name: str) -> Texture | None:
        """Return a texture from its file, None where no pack has one that can be read."""
        plain = name.removesuffix(CLEAR)
        try:
            space, path = resource(plain, "texture")
        except ValueError:
            return None
        file = f"assets/{space}/textures/{path}.png"
        animation = self._animation(file)
        for where, data in self._resources.versions(file, MOST_PNG_BYTES):
            try:
                frame = first_frame(decode_png(data), animation)
            except ValueError as error:
                self._resources.note(f"{where}: {error}")
                continue
            clear = name.endswith(CLEAR) or is_clear(path)
            return self._texture(frame, file, animation, clear)
        return None

    def _animation(self, file: str) -> Mapping[str, Any] | None:
        name = file + ".mcmeta"
        root = self._resources.object(name) if self._resources.has(name) else None
        if root is None or "animation" not in root:
            return None
        try:
            return mapping(root["animation"], "animation")
        except ValueError as error:
            self._resources.note(f"{name}: {error}")
            return None

    def _texture(self, frame: np.ndarray, file: str, animation, clear: bool) -> Texture:
        side = side_for(frame, self._most_px)
        colour = resampled(frame, side).copy()  # Not a view that keeps a whole strip.
        alpha = colour[..., 3]
        share = float(((alpha > HOLE) & (alpha < SOLID)).mean())
        relief = self._beside(file, "_n", animation, side)
        material = self._beside(file, "_s", animation, side)
        roughness, metal, emission = (None,) * 3 if material is None else material_maps(material)
        return Texture(
            colour,
            None if relief is None else normal_map(relief),
            roughness,
            metal,
            emission,
            translucent=clear and share >= LEAST_CLEAR_SHARE,
        )

    def _beside(self, file: str, ending: str, animation, side: int) -> np.ndarray | None:
        """Return the pixels of a map beside a texture, uint8 [N, N, 4], or None."""
        name = file.removesuffix(".png") + ending + ".png"
        own = self._animation(name) or animation
        for where, data in self._resources.versions(name, MOST_PNG_BYTES):
            try:
                pixels = decode_png(data)
                strip = own is not None and pixels.shape[0] != pixels.shape[1]
                pixels = first_frame(pixels, own if strip else None)
                # Alpha of a material is light, not cover: the channels are averaged apart.
                halves = (resampled(half, side) for half in (pixels[..., :3], pixels[..., 3:]))
                return np.concatenate(list(halves), axis=-1)
            except ValueError as error:
                self._resources.note(f"{where}: {error}")
        return None

    def _joined(self, parts: list[str]) -> Texture | None:
        """Return textures laid one over another, ``a*rrggbb+b``, None where one is missing."""
        layers = []
        for part in parts:
            name, _, tint = part.partition(TIMES)
            texture = self.get(name)
            if texture is None or (tint and not re.fullmatch("[0-9a-f]{6}", tint)):
                return None
            layers.append((texture, tuple(bytes.fromhex(tint or "ffffff"))))
        return joined(layers)
