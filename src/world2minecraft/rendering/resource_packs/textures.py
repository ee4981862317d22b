"""Textures of resource packs: PNG decoding, resampling, labPBR maps and overlays.

Only the first frame of an animation is used. It is resampled to a square whose side is a power of
two. Two files beside a texture contain labPBR 1.3 maps: ``NAME_n.png`` the relief, ``NAME_s.png``
the material. Older layouts of ``_s`` cannot be distinguished and are read in the same way.
"""

import io
import re
import struct
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.rendering.atlas import to_linear
from world2minecraft.rendering.light.tone_mapping import linear_to_srgb
from world2minecraft.rendering.resource_packs.elements import OVER, TIMES
from world2minecraft.rendering.resource_packs.json_validation import (
    as_list,
    as_number,
    as_object,
    parse_resource_name,
)
from world2minecraft.rendering.resource_packs.pack_files import PackStack
from world2minecraft.rendering.texture import MAX_SIDE_PX, Texture

# The maps of a texture, and what stands for one that a layer lacks where another has it.
FLAT = {"normal": (128, 128, 255), "roughness": 204, "metal": 0, "emission": 0}
FIRST_METAL = 230  # Green values from this are metals; lower ones are reflectance.
NO_EMISSION = 255  # Alpha value without emission; 254 is full emission.
MAX_PIXELS = 1 << 25  # 32 frames of 1024 x 1024.
_HEAD = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"
MAX_PNG_BYTES = 32 << 20
MAX_TEXTURES = 8192  # Maximum number in a run; the game has about 1,500 for blocks.
MIN_PX, MAX_PX = 16, 128  # The sides that the renderer's textures have.
SAMPLE = 100  # Number of textures that determine the usual size.
CLEAR = "~clear"  # Ends the name of a texture that a block of clear stuff uses.
_CLEAR_WORDS = re.compile(r"glass|(?<![a-z])ice(?![a-z])|slime|honey_block|water|portal|jelly")
# A texture of clear stuff mixes with what is behind it where this share is neither hole nor solid.
MIN_CLEAR_SHARE = 0.15
HOLE, SOLID = 13, 242  # Alpha values up to and from which a texel is a hole or solid.


def overlay_textures(layers: Sequence[tuple[Texture, tuple[int, ...]]]) -> Texture:
    """Combine texture layers into one texture.

    Args:
        layers: At least one texture with its sRGB colour multiplier, bottom layer first.
    """
    side = max(texture.colour.shape[0] for texture, _ in layers)
    done: Texture | None = None
    for texture, tint in layers:
        above = _tint(_upscale(texture, side), np.array(tint))
        done = above if done is None else _blend_over(done, above)
    if done is None:
        raise ValueError("at least one texture layer is required")
    return done


def _upscale(texture: Texture, side: int) -> Texture:
    """Return a texture with each pixel repeated; sides are powers of two."""
    times = side // texture.colour.shape[0]
    maps = {
        name: None if (held := getattr(texture, name)) is None else _repeat_pixels(held, times)
        for name in FLAT
    }
    return replace(texture, colour=_repeat_pixels(texture.colour, times), **maps)


def _repeat_pixels(pixels: np.ndarray, times: int) -> np.ndarray:
    return pixels.repeat(times, axis=0).repeat(times, axis=1)


def _tint(texture: Texture, tint: np.ndarray) -> Texture:
    """Return a texture times a colour, multiplied in linear light."""
    if (tint == 255).all():
        return texture
    colour = texture.colour.copy()
    product = to_linear(colour[..., :3]) * to_linear(tint)
    colour[..., :3] = np.round(linear_to_srgb(product) * 255)
    return replace(texture, colour=colour)


def _blend_over(below: Texture, above: Texture) -> Texture:
    """Return one texture over another; each map is that of the one that is seen."""
    cover = above.colour[..., 3:] / 255
    if not above.translucent:
        cover = (cover >= 0.5).astype(np.float64)
    colour = below.colour.copy()
    mixed = below.colour[..., :3] * (1 - cover) + above.colour[..., :3] * cover
    colour[..., :3] = np.round(mixed)
    colour[..., 3] = np.maximum(below.colour[..., 3], above.colour[..., 3])
    seen = cover[..., 0] >= 0.5
    maps: dict[str, np.ndarray | None] = {}
    for name, value in FLAT.items():
        lower, upper = getattr(below, name), getattr(above, name)
        if lower is None and upper is None:
            continue
        flat = np.zeros((*seen.shape, 3) if name == "normal" else seen.shape, np.uint8)
        flat[...] = value
        lower, upper = (flat if one is None else one for one in (lower, upper))
        maps[name] = np.where(seen[..., None] if name == "normal" else seen, upper, lower)
    is_clear = (below.translucent or above.translucent) and bool((colour[..., 3] < 255).any())
    return replace(below, colour=colour, translucent=is_clear, **maps)


def normal_map(pixels: np.ndarray) -> np.ndarray:
    """Return tangent-space normals, uint8 [N, N, 3], from ``_n`` pixels, uint8 [N, N, 4].

    Red is x along u, green is y along v (DirectX convention, down). The third component is
    computed. Blue (occlusion) and alpha (height) are ignored.
    """
    plane = pixels[..., :2] / 255 * 2 - 1
    length = np.maximum(np.sqrt((plane**2).sum(axis=-1, keepdims=True)), 1.0)
    plane = plane / length
    outward = np.sqrt(np.clip(1 - (plane**2).sum(axis=-1, keepdims=True), 0, 1))
    normal = np.concatenate([plane, outward], axis=-1)
    return np.clip(np.round(128 + 127 * normal), 0, 255).astype(np.uint8)


def material_maps(pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (roughness, metal, emission), uint8 [N, N] each, from ``_s`` pixels [N, N, 4].

    Red is perceptual smoothness, green of 230 or more is metal, and alpha is the emission.
    """
    roughness = 255 - pixels[..., 0]
    metal = np.where(pixels[..., 1] >= FIRST_METAL, 255, 0).astype(np.uint8)
    alpha = pixels[..., 3].astype(np.uint16)
    emission = np.where(alpha == NO_EMISSION, 0, (alpha * 255 + 127) // 254).astype(np.uint8)
    return roughness, metal, emission


def png_size(data: bytes) -> tuple[int, int]:
    """Return the width and height in a PNG header.

    Raises:
        ValueError: If the data is not a PNG file.
    """
    if not data.startswith(_HEAD) or len(data) < 24:
        raise ValueError("not a PNG file")
    width, height = struct.unpack(">II", data[16:24])
    return width, height


def decode_png(data: bytes) -> np.ndarray:
    """Decode a PNG to uint8 [H, W, 4] after checking its size.

    Raises:
        ValueError: If the data is not a PNG file, is damaged or is too large.
    """
    width, height = png_size(data)
    if not 0 < width * height <= MAX_PIXELS:
        raise ValueError(f"image has {width} x {height} pixels, the limit is {MAX_PIXELS:,} pixels")
    try:
        with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
            if image.mode.startswith("I"):  # 16 bits of grey.
                grey = Image.fromarray((np.asarray(image) >> 8).astype(np.uint8))
                return np.array(grey.convert("RGBA"))
            return np.array(image.convert("RGBA"))
    except Exception as error:  # Pillow raises dozens of kinds over damaged files.
        raise ValueError(f"damaged PNG file ({error})") from error


def first_frame(pixels: np.ndarray, animation: Mapping[str, Any] | None) -> np.ndarray:
    """Return the first frame of an animation, or the whole image without an animation.

    Args:
        pixels: Image, uint8 [H, W, 4].
        animation: ``animation`` object of the ``.mcmeta`` file beside the image.

    Raises:
        ValueError: If the animation is invalid.
    """
    if animation is None:
        return pixels
    height, width = pixels.shape[:2]
    wide, tall = animation.get("width"), animation.get("height")
    if wide is None and tall is None:
        wide = tall = min(width, height)
    wide = int(as_number(width if wide is None else wide, "width of a frame", 1, width))
    tall = int(as_number(height if tall is None else tall, "height of a frame", 1, height))
    index = _first_index(animation.get("frames"))
    columns, rows = width // wide, height // tall
    if index >= columns * rows:
        raise ValueError(
            f"the first frame must be below {columns * rows}, the number of frames, got {index}"
        )
    row, column = divmod(index, columns)
    return pixels[row * tall : (row + 1) * tall, column * wide : (column + 1) * wide]


def _first_index(frames: Any) -> int:
    if frames is None or frames == []:
        return 0
    first = as_list(frames, "frames", 100_000)[0]
    if isinstance(first, dict):
        first = as_object(first, "a frame").get("index")
    return int(as_number(first, "index of a frame", 0, 100_000))


def side_for(pixels: np.ndarray, most_px: int) -> int:
    """Return the side of the square texture for a frame: a power of two that contains it."""
    longest = max(pixels.shape[:2])
    return min(1 << (longest - 1).bit_length(), most_px, MAX_SIDE_PX)


def resampled(pixels: np.ndarray, side_px: int) -> np.ndarray:
    """Resample an image to uint8 [N, N, C], each pixel the mean of the area that it covers.

    Colours with alpha are weighted by it, so that holes do not cause dark edges.
    """
    if pixels.shape[:2] == (side_px, side_px):
        return pixels
    down, across = (_area_weights(count, side_px) for count in pixels.shape[:2])
    values = pixels.astype(np.float64)
    if pixels.shape[2] != 4:
        return _bytes(np.einsum("ij,kl,jlc->ikc", down, across, values, optimize=True))
    alpha = np.where(values[..., 3:] == 0, 1e-6, values[..., 3:])
    values[..., :3] *= alpha
    values[..., 3:] = alpha
    mean = np.einsum("ij,kl,jlc->ikc", down, across, values, optimize=True)
    mean[..., :3] /= mean[..., 3:]
    return _bytes(mean)


def _bytes(values: np.ndarray) -> np.ndarray:
    return np.clip(values + 0.5, 0, 255).astype(np.uint8)


def _area_weights(count: int, side_px: int) -> np.ndarray:
    """Return float64 [side_px, count]: the share that each old pixel has of each new one."""
    edges = np.arange(side_px + 1) * (count / side_px)
    low, high = edges[:-1, None], edges[1:, None]
    old = np.arange(count)[None, :]
    return np.clip(np.minimum(high, old + 1) - np.maximum(low, old), 0, None) / (high - low)


def names_clear_material(name: str) -> bool:
    """Return whether the name of a block or texture stands for a transparent material."""
    return _CLEAR_WORDS.search(name) is not None


def _power(value: int) -> int:
    """Return the least power of two that is not smaller."""
    return 1 << max(value - 1, 0).bit_length()


class PackTextures:
    """The textures of a stack of packs, each loaded once."""

    def __init__(self, resources: PackStack, most_px: int):
        self._resources, self._most_px = resources, most_px
        self._read: dict[str, Texture | None] = {}

    def get(self, name: str) -> Texture | None:
        """Return the texture of a name that a model of these packs uses, or None."""
        if name not in self._read:
            if len(self._read) >= MAX_TEXTURES:
                self._resources.note(
                    f"more than {MAX_TEXTURES:,} textures; the remaining textures are ignored"
                )
                return None
            parts = name.split(OVER)
            self._read[name] = self._one(name) if len(parts) == 1 else self._joined(parts)
        return self._read[name]

    def usual_px(self) -> int:
        """Return the most common side of block textures, by a sample: 16, 32, 64 or 128."""
        names = self._resources.pictures()
        sides: Counter[int] = Counter()
        for name in names[:: max(1, len(names) // SAMPLE)]:
            for _, data in self._resources.versions(name, MAX_PNG_BYTES):
                try:
                    sides[min(max(_power(png_size(data)[0]), MIN_PX), MAX_PX)] += 1
                except ValueError:
                    continue  # It is reported where it is used.
                break
        return max(sides, key=lambda side: (sides[side], side), default=MIN_PX)

    def map_colour(self, name: str, column: int, row: int) -> tuple[int, int, int] | None:
        """Return a pixel of a 256 x 256 colour map, or None if no pack has the map."""
        file = f"assets/minecraft/textures/colormap/{name}.png"
        for where, data in self._resources.versions(file, MAX_PNG_BYTES):
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
            space, path = parse_resource_name(plain, "texture")
        except ValueError:
            return None
        file = f"assets/{space}/textures/{path}.png"
        animation = self._animation(file)
        for where, data in self._resources.versions(file, MAX_PNG_BYTES):
            try:
                frame = first_frame(decode_png(data), animation)
            except ValueError as error:
                self._resources.note(f"{where}: {error}")
                continue
            clear = name.endswith(CLEAR) or names_clear_material(path)
            return self._texture(frame, file, animation, clear)
        return None

    def _animation(self, file: str) -> Mapping[str, Any] | None:
        name = file + ".mcmeta"
        root = self._resources.object(name) if self._resources.has(name) else None
        if root is None or "animation" not in root:
            return None
        try:
            return as_object(root["animation"], "animation")
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
            translucent=clear and share >= MIN_CLEAR_SHARE,
        )

    def _beside(self, file: str, ending: str, animation, side: int) -> np.ndarray | None:
        """Return the pixels of a map beside a texture, uint8 [N, N, 4], or None."""
        name = file.removesuffix(".png") + ending + ".png"
        own = self._animation(name) or animation
        for where, data in self._resources.versions(name, MAX_PNG_BYTES):
            try:
                pixels = decode_png(data)
                strip = own is not None and pixels.shape[0] != pixels.shape[1]
                pixels = first_frame(pixels, own if strip else None)
                # Alpha of a material is light, not cover: the channels are averaged separately.
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
        return overlay_textures(layers)
