"""Messages to a language model: turns of text and pictures, questions and replies.

A question is identified by its key, the SHA-256 of all that could change the reply, with each
picture replaced by its own digest, so that records of questions stay small and readable. Pictures
are downscaled before they are sent: every pixel costs tokens, time and money.
"""

import base64
import hashlib
import json
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.core.errors import UsageError

ROLES = ("system", "user", "assistant")
PICTURE_KINDS = ("image/jpeg", "image/png", "image/webp")
MAX_PX = 1_048_576  # 1,338 tokens of Qwen2.5-VL, within what the budget counts for a picture.
MIN_PX = 784  # One token's square of 28 x 28.
MAX_FILE_PX = 64_000_000  # Of a file; more is not opened.
JPEG_QUALITY = 90


@dataclass(frozen=True)
class Picture:
    """An encoded picture, ``data`` of the media type ``kind``."""

    data: bytes
    kind: str = "image/jpeg"

    def __post_init__(self):
        if self.kind not in PICTURE_KINDS:
            known = ", ".join(PICTURE_KINDS)
            raise UsageError(f"a picture for a model is one of {known}, not {self.kind!r}")

    @property
    def sha256(self) -> str:
        """The digest of its bytes, hexadecimal."""
        return hashlib.sha256(self.data).hexdigest()

    @property
    def url(self) -> str:
        """The picture as a data URL."""
        return f"data:{self.kind};base64,{base64.b64encode(self.data).decode()}"


@dataclass(frozen=True)
class Turn:
    """A message of one side: texts and pictures in their order."""

    role: str
    parts: tuple[str | Picture, ...]

    def __post_init__(self):
        if self.role not in ROLES:
            raise UsageError(f"a turn is of one of {', '.join(ROLES)}, not {self.role!r}")

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """The pictures alone."""
        return tuple(part for part in self.parts if isinstance(part, Picture))

    def to_api(self) -> dict[str, Any]:
        """Return the turn in the format of chat servers."""
        if not self.pictures:
            return {"role": self.role, "content": "".join(map(str, self.parts))}
        return {"role": self.role, "content": [_content_part(part) for part in self.parts]}

    def to_record(self) -> dict[str, Any]:
        """Return the turn for a record; pictures are their digests."""
        parts = [
            {"picture": part.sha256} if isinstance(part, Picture) else part for part in self.parts
        ]
        return {"role": self.role, "parts": parts}


@dataclass(frozen=True)
class Question:
    """A request to a model.

    ``form`` is the ``response_format`` of the protocol, None for free text. ``sample``
    distinguishes questions that are asked again on purpose, to see how much replies differ.
    """

    model: str
    turns: tuple[Turn, ...]
    temperature: float | None = 0.0  # None leaves it to the server; some models take no other.
    max_tokens: int = 1024
    form: dict[str, Any] | None = None
    sample: int = 0

    def to_record(self) -> dict[str, Any]:
        """Return the question for a record; pictures are their digests."""
        return {
            "model": self.model,
            "turns": [turn.to_record() for turn in self.turns],
            "temperature": self.temperature,
            "max_tokens": self.max_tokens,
            "form": self.form,
            "sample": self.sample,
        }

    @property
    def key(self) -> str:
        """The digest that identifies this question, hexadecimal.

        Example:
            >>> Question("m", (Turn("user", ("Hello",)),)).key[:8]
            '5e694ce7'
        """
        text = json.dumps(self.to_record(), sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def pictures(self) -> int:
        """The number of pictures."""
        return sum(len(turn.pictures) for turn in self.turns)

    @property
    def characters(self) -> int:
        """The number of characters of its texts."""
        parts = [part for turn in self.turns for part in turn.parts]
        return sum(len(part) for part in parts if isinstance(part, str))


@dataclass(frozen=True)
class Reply:
    """A reply of a model to a question.

    Tokens are as the server counts them; where it does not, they are estimated.
    """

    text: str
    prompt_tokens: int
    completion_tokens: int
    finish: str = "stop"  # "length" where it was cut
    is_estimated: bool = False
    latency_s: float = 0.0
    attempts: int = 1
    is_replayed: bool = False


def _content_part(part: str | Picture) -> dict[str, Any]:
    if isinstance(part, Picture):
        return {"type": "image_url", "image_url": {"url": part.url}}
    return {"type": "text", "text": part}


def check_max_px(max_px: int) -> None:
    """Raise UsageError where a cap on pixels is too small."""
    if max_px < MIN_PX:
        raise UsageError(f"a picture for a model has {MIN_PX} pixels or more, not {max_px}")


def downscale(colour: np.ndarray, max_px: int) -> np.ndarray:
    """Return a picture, uint8 [H, W, 3], of at most so many pixels, in its own shape.

    Example:
        >>> downscale(np.zeros((480, 640, 3), np.uint8), 76_800).shape
        (240, 320, 3)
    """
    height, width = colour.shape[:2]
    size = _size_within(width, height, max_px)
    if size == (width, height):
        return colour
    return np.asarray(Image.fromarray(colour).resize(size, Image.Resampling.LANCZOS))


def downscale_picture(picture: Picture, max_px: int) -> Picture:
    """Return a picture as it is, or a smaller JPEG of it where it has more pixels.

    Raises:
        ValueError: it cannot be opened, or is far too large to be.
    """
    try:
        with Image.open(BytesIO(picture.data)) as image:
            if image.width * image.height > MAX_FILE_PX:
                raise ValueError(f"has {image.width} x {image.height} pixels, too many to open")
            size = _size_within(image.width, image.height, max_px)
            if size == image.size:
                return picture
            small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise ValueError(f"is no picture that can be opened ({error})") from error
    stream = BytesIO()
    small.save(stream, "JPEG", quality=JPEG_QUALITY)
    return Picture(stream.getvalue(), "image/jpeg")


def _size_within(width: int, height: int, max_px: int) -> tuple[int, int]:
    """Return the size of a picture that may have so many pixels."""
    if width * height <= max_px:
        return width, height
    scale = (max_px / (width * height)) ** 0.5
    wide = max(1, int(width * scale))
    return wide, max(1, min(int(height * scale), max_px // wide))
