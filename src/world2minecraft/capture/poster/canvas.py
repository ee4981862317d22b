"""The canvas of a poster, drawn at twice its size and downscaled."""

import unicodedata

import numpy as np
from PIL import Image, ImageDraw, ImageFont

SUPERSAMPLING = 2  # Lines and letters are drawn at twice the size: edges come out smooth.
PAPER, INK, FAINT, RULE = (252, 251, 248), (34, 38, 43), (112, 118, 125), (219, 216, 208)
PANEL = (243, 241, 235)
OK, WARN, STOP = (62, 142, 96), (214, 138, 22), (196, 62, 46)
FIRST, LAST = (16, 118, 150), (214, 62, 110)  # Colours of the first and last camera of a path.
LEVELS = {"ok": OK, "warn": WARN, "stop": STOP}
Colour = tuple[int, int, int]
Point = tuple[float, float]


def blend_colours(one: Colour, other: Colour, share: float) -> Colour:
    """Interpolate linearly between two colours."""
    mixed = [round(a + (b - a) * share) for a, b in zip(one, other, strict=True)]
    return mixed[0], mixed[1], mixed[2]


class Sheet:
    """A page with coordinates in final pixels, which may be fractional."""

    def __init__(self, width_px: int, height_px: int):
        self.image = Image.new("RGB", (width_px * SUPERSAMPLING, height_px * SUPERSAMPLING), PAPER)
        self.draw = ImageDraw.Draw(self.image)

    def text(
        self, at: Point, words: str, size: float, colour: Colour = INK, *,
        bold: bool = False, anchor: str = "la",
    ) -> None:  # fmt: skip
        """Draw one line of text; ``anchor`` is a Pillow anchor, such as ``mm`` for the middle."""
        font = ImageFont.load_default(size * SUPERSAMPLING)
        self.draw.text(
            (at[0] * SUPERSAMPLING, at[1] * SUPERSAMPLING), to_ascii(words), colour, font, anchor,
            stroke_width=1 if bold else 0, stroke_fill=colour,
        )  # fmt: skip

    def width(self, words: str, size: float) -> float:
        """Return the width of a line of text in final pixels."""
        return (
            self.draw.textlength(to_ascii(words), ImageFont.load_default(size * SUPERSAMPLING))
            / SUPERSAMPLING
        )

    def wrapped(self, words: str, size: float, width: float) -> list[str]:
        """Wrap a text into lines of limited width."""
        lines, line = [], ""
        for word in words.split():
            tried = f"{line} {word}".strip()
            if line and self.width(tried, size) > width:
                lines.append(line)
                tried = word
            line = tried
        return [*lines, line] if line else lines

    def clipped(self, words: str, size: float, width: float) -> str:
        """Return a text, shortened in the middle if it is wider than ``width``."""
        if self.width(words, size) <= width:
            return words
        keep = len(words)
        while keep > 4 and self.width(_elide(words, keep), size) > width:
            keep -= 1
        return _elide(words, keep)

    def box(
        self, corner: Point, size: Point, fill: Colour | None = None,
        outline: Colour | None = None, radius: float = 0, line: float = 1,
    ) -> None:  # fmt: skip
        """Draw a rectangle with rounded corners."""
        ends = (*corner, corner[0] + size[0], corner[1] + size[1])
        self.draw.rounded_rectangle(
            [value * SUPERSAMPLING for value in ends],
            radius * SUPERSAMPLING,
            fill,
            outline,
            round(line * SUPERSAMPLING),
        )

    def line(self, points: list[Point], colour: Colour, width: float = 1) -> None:
        """Draw a polyline."""
        flat = [(x * SUPERSAMPLING, y * SUPERSAMPLING) for x, y in points]
        self.draw.line(flat, colour, max(1, round(width * SUPERSAMPLING)), joint="curve")

    def shape(self, points: list[Point], fill: Colour, alpha: float = 1.0) -> None:
        """Fill a polygon, which is transparent for ``alpha`` below 1."""
        flat = np.array(points) * SUPERSAMPLING
        low = np.floor(flat.min(axis=0)).astype(int)
        high = np.ceil(flat.max(axis=0)).astype(int) + 1
        mask = Image.new("L", (int(high[0] - low[0]), int(high[1] - low[1])), 0)
        corners = [(float(x), float(y)) for x, y in flat - low]
        ImageDraw.Draw(mask).polygon(corners, round(255 * alpha))
        self.image.paste(fill, (int(low[0]), int(low[1])), mask)

    def dot(self, at: Point, radius: float, fill: Colour, outline: Colour | None = None) -> None:
        """Draw a filled circle."""
        ends = (at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius)
        width = 2 if outline else 0
        self.draw.ellipse([value * SUPERSAMPLING for value in ends], fill, outline, width)

    def picture(self, pixels: np.ndarray, corner: Point, size: Point, smooth: bool = True) -> None:
        """Draw an image, uint8 [H, W, 3], stretched to a box."""
        target = (round(size[0] * SUPERSAMPLING), round(size[1] * SUPERSAMPLING))
        resampling = Image.Resampling.BICUBIC if smooth else Image.Resampling.NEAREST
        at = (round(corner[0] * SUPERSAMPLING), round(corner[1] * SUPERSAMPLING))
        self.image.paste(Image.fromarray(pixels).resize(target, resampling), at)

    def finished(self) -> np.ndarray:
        """Return the page as uint8 [H, W, 3]."""
        return np.asarray(self.image.reduce(SUPERSAMPLING))


def to_ascii(words: str) -> str:
    """Convert a text to ASCII, which the font supports, by removing accents."""
    split = unicodedata.normalize("NFKD", words)
    letters = "".join(letter for letter in split if not unicodedata.combining(letter))
    return letters.encode("ascii", "replace").decode()


def _elide(words: str, keep: int) -> str:
    front = keep // 2
    return f"{words[:front]}...{words[len(words) - (keep - front) :]}" if keep else "..."
