"""What is said to a language model and what it says: turns of text and pictures, and a reply.

A question is known by its key, the SHA-256 of all that could change the reply, with each picture
replaced by its own sum. So a record of what was asked stays small, and shows what was asked.
"""

import base64
import hashlib
import json
from dataclasses import dataclass
from typing import Any

from world2minecraft.core.errors import UsageError

ROLES = ("system", "user", "assistant")
PICTURE_KINDS = ("image/jpeg", "image/png", "image/webp")


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
        """The sum of its bytes, hexadecimal."""
        return hashlib.sha256(self.data).hexdigest()

    @property
    def url(self) -> str:
        """The picture as a data URL."""
        return f"data:{self.kind};base64,{base64.b64encode(self.data).decode()}"


@dataclass(frozen=True)
class Turn:
    """What one side says: texts and pictures in their order."""

    role: str
    parts: tuple[str | Picture, ...]

    def __post_init__(self):
        if self.role not in ROLES:
            raise UsageError(f"a turn is of one of {', '.join(ROLES)}, not {self.role!r}")

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """The pictures alone."""
        return tuple(part for part in self.parts if isinstance(part, Picture))

    def wire(self) -> dict[str, Any]:
        """Return the turn as chat servers take it."""
        if not self.pictures:
            return {"role": self.role, "content": "".join(map(str, self.parts))}
        return {"role": self.role, "content": [_wire(part) for part in self.parts]}

    def told(self) -> dict[str, Any]:
        """Return the turn for a record: pictures are their sums."""
        parts = [
            {"picture": part.sha256} if isinstance(part, Picture) else part for part in self.parts
        ]
        return {"role": self.role, "parts": parts}


@dataclass(frozen=True)
class Question:
    """All that a model is asked at once.

    ``form`` is the ``response_format`` of the protocol, None for free text. ``sample`` tells apart
    questions that are asked again on purpose, to see how much replies differ.
    """

    model: str
    turns: tuple[Turn, ...]
    temperature: float | None = 0.0  # None leaves it to the server; some models take no other.
    max_tokens: int = 1024
    form: dict[str, Any] | None = None
    sample: int = 0

    def told(self) -> dict[str, Any]:
        """Return the question for a record: pictures are their sums."""
        return {
            "model": self.model,
            "turns": [turn.told() for turn in self.turns],
            "temperature": self.temperature,
            "max_tokens": self.max_tokens,
            "form": self.form,
            "sample": self.sample,
        }

    @property
    def key(self) -> str:
        """What tells this question from any other, hexadecimal.

        Example:
            >>> Question("m", (Turn("user", ("Hello",)),)).key[:8]
            '5e694ce7'
        """
        text = json.dumps(self.told(), sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def pictures(self) -> int:
        """How many pictures are shown."""
        return sum(len(turn.pictures) for turn in self.turns)

    @property
    def characters(self) -> int:
        """How long its texts are."""
        parts = [part for turn in self.turns for part in turn.parts]
        return sum(len(part) for part in parts if isinstance(part, str))


@dataclass(frozen=True)
class Reply:
    """What a model said to a question.

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


def _wire(part: str | Picture) -> dict[str, Any]:
    if isinstance(part, Picture):
        return {"type": "image_url", "image_url": {"url": part.url}}
    return {"type": "text", "text": part}
