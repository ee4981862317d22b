"""Messages to language models: turns of text and images, questions and replies.

A question is identified by its key, the SHA-256 of everything that can change the reply. In the
record of a question, images are replaced by their digests, which keeps records small and readable.
Images are downscaled before they are sent, because pixels cost tokens, time and money.
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
    """An encoded image with its media type ``kind``."""

    data: bytes
    kind: str = "image/jpeg"

    def __post_init__(self):
        if self.kind not in PICTURE_KINDS:
            known = ", ".join(PICTURE_KINDS)
            raise UsageError(f"an image for a model must be one of {known}, got {self.kind!r}")

    @property
    def sha256(self) -> str:
        """The SHA-256 of the image data in hexadecimal."""
        return hashlib.sha256(self.data).hexdigest()

    @property
    def url(self) -> str:
        """The image as a data URL."""
        return f"data:{self.kind};base64,{base64.b64encode(self.data).decode()}"


@dataclass(frozen=True)
class Turn:
    """A message of one role with texts and images in order."""

    role: str
    parts: tuple[str | Picture, ...]

    def __post_init__(self):
        if self.role not in ROLES:
            raise UsageError(
                f"the role of a turn must be one of {', '.join(ROLES)}, got {self.role!r}"
            )

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """The images of the message."""
        return tuple(part for part in self.parts if isinstance(part, Picture))

    def to_api(self) -> dict[str, Any]:
        """Return the turn in the format of the chat API."""
        if not self.pictures:
            return {"role": self.role, "content": "".join(map(str, self.parts))}
        return {"role": self.role, "content": [_content_part(part) for part in self.parts]}

    def to_record(self) -> dict[str, Any]:
        """Return the turn as JSON data for a record, with images replaced by their digests."""
        parts = [
            {"picture": part.sha256} if isinstance(part, Picture) else part for part in self.parts
        ]
        return {"role": self.role, "parts": parts}


@dataclass(frozen=True)
class Question:
    """A request to a model.

    Attributes:
        model: The name of the model.
        turns: The messages.
        temperature: The sampling temperature. None uses the server's default.
        max_tokens: The maximum number of tokens of the reply.
        form: The ``response_format`` of the protocol. None requests free text.
        sample: A number that distinguishes intended repetitions of the same question.
    """

    model: str
    turns: tuple[Turn, ...]
    temperature: float | None = 0.0  # None leaves it to the server; some models take no other.
    max_tokens: int = 1024
    form: dict[str, Any] | None = None
    sample: int = 0

    def to_record(self) -> dict[str, Any]:
        """Return the question as JSON data for a record, with images replaced by their digests."""
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
        """The hexadecimal digest that identifies the question.

        Example:
            >>> Question("m", (Turn("user", ("Hello",)),)).key[:8]
            '5e694ce7'
        """
        text = json.dumps(self.to_record(), sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def pictures(self) -> int:
        """The number of images."""
        return sum(len(turn.pictures) for turn in self.turns)

    @property
    def characters(self) -> int:
        """The number of characters of all texts."""
        parts = [part for turn in self.turns for part in turn.parts]
        return sum(len(part) for part in parts if isinstance(part, str))


@dataclass(frozen=True)
class Reply:
    """The reply of a model to a question.

    Attributes:
        text: The text of the reply.
        prompt_tokens: The number of prompt tokens.
        completion_tokens: The number of completion tokens.
        finish: The reason for the end of the reply, "length" if it was truncated.
        is_estimated: Whether the token counts are estimates, because the server reported none.
        latency_s: The response time in seconds.
        attempts: The number of attempts.
        is_replayed: Whether the reply comes from the cache.
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
    """Check that a limit on image pixels is large enough.

    Raises:
        UsageError: If the limit is too small.
    """
    if max_px < MIN_PX:
        raise UsageError(f"max_px must be {MIN_PX} or more, got {max_px}")


def downscale(colour: np.ndarray, max_px: int) -> np.ndarray:
    """Downscale an image, uint8 [H, W, 3], to at most ``max_px`` pixels, keeping its aspect ratio.

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
    """Return an image unchanged, or downscaled as JPEG if it has too many pixels.

    Raises:
        ValueError: If the image cannot be opened or is too large to open.
    """
    try:
        with Image.open(BytesIO(picture.data)) as image:
            if image.width * image.height > MAX_FILE_PX:
                raise ValueError(
                    f"the image has {image.width} x {image.height} pixels, too many to open"
                )
            size = _size_within(image.width, image.height, max_px)
            if size == image.size:
                return picture
            small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise ValueError(f"not an image that can be opened ({error})") from error
    stream = BytesIO()
    small.save(stream, "JPEG", quality=JPEG_QUALITY)
    return Picture(stream.getvalue(), "image/jpeg")


def _size_within(width: int, height: int, max_px: int) -> tuple[int, int]:
    """Return the image size within a number of pixels."""
    if width * height <= max_px:
        return width, height
    scale = (max_px / (width * height)) ** 0.5
    wide = max(1, int(width * scale))
    return wide, max(1, min(int(height * scale), max_px // wide))
