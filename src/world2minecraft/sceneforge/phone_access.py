"""Who may use the phone page: codes that work once, and the sessions of phones.

A code is a link whose fragment holds a token of 128 bits. Browsers send no fragment to servers, so
that a preview of the link does not use the code up. The script of the page sends the token in a
request of its own, and receives the cookie of a session in return.
"""

import io
import secrets
import time
from collections import OrderedDict, deque
from collections.abc import Callable
from dataclasses import dataclass, field
from hmac import compare_digest

import segno

from world2minecraft.core.errors import World2MinecraftError

TOKEN_BYTES = 16  # 22 characters: the code stays coarse enough for any camera.
SESSION_BYTES = 32
CODE_LIFE_S = 600.0
SESSION_LIFE_S = 12 * 3600.0
MAX_WRONG = 5  # Wrong tokens of one address within ``WRONG_WINDOW_S``.
WRONG_WINDOW_S = 60.0
MAX_ADDRESSES = 1000  # Addresses whose wrong tokens are remembered.
ON_BLACK = "\x1b[38;5;231;48;5;16m{}\x1b[0m"  # Scanners want dark on light, whatever the terminal.


class WrongCodeError(World2MinecraftError):
    """A token is not that of the current code, which may be used or too old."""


class TooManyTriesError(World2MinecraftError):
    """An address sent too many wrong tokens and must wait."""


@dataclass
class Phone:
    """A phone with access: when its session ends, and the ids of its captures in order."""

    until_s: float
    captures: list[str] = field(default_factory=list)


class PhoneAccess:
    """The codes and the sessions of one phone page. It is used by one thread at a time.

    Args:
        url: URL of the phone page, without a token.
        clock: Monotonic clock in seconds.
    """

    def __init__(self, url: str, clock: Callable[[], float] = time.monotonic):
        self.url, self._clock = url, clock
        self._token, self._ends_s = "", 0.0
        self._phones: dict[str, Phone] = {}
        self._wrong: OrderedDict[str, deque[float]] = OrderedDict()

    def new_code(self) -> str:
        """Return a link that lets one phone in, and end the previous link."""
        self._token = secrets.token_urlsafe(TOKEN_BYTES)
        self._ends_s = self._clock() + CODE_LIFE_S
        return self.link

    @property
    def link(self) -> str:
        """The current link, or an empty string if it is used or too old."""
        return f"{self.url}#{self._token}" if self._token and self.left_s > 0 else ""

    @property
    def left_s(self) -> float:
        """The number of seconds for which the current code is valid."""
        return max(self._ends_s - self._clock(), 0.0) if self._token else 0.0

    @property
    def phones(self) -> list[Phone]:
        """The phones that are let in."""
        return list(self._current().values())

    def pair(self, token: str, address: str) -> str:
        """Exchange the token of the current code for a session, and end the code.

        Args:
            token: The token that a page sent.
            address: Network address of the sender, whose wrong tokens are counted.

        Raises:
            TooManyTriesError: If the address sent too many wrong tokens within a minute.
            WrongCodeError: If the token is wrong, used or too old.
        """
        now = self._clock()
        wrong = self._wrong.get(address, deque())
        while wrong and wrong[0] <= now - WRONG_WINDOW_S:
            wrong.popleft()
        if len(wrong) >= MAX_WRONG:
            raise TooManyTriesError("too many wrong codes; wait a minute, then scan a new code")
        if not (self.link and compare_digest(token.encode(errors="replace"), self._token.encode())):
            self._note_wrong(address, wrong, now)
            raise WrongCodeError("this code is used or too old; show a new one and scan it")
        self._token = ""
        session = secrets.token_urlsafe(SESSION_BYTES)
        self._phones[session] = Phone(now + SESSION_LIFE_S)
        return session

    def phone(self, session: str) -> Phone | None:
        """Return the phone of a session, or None if there is none or it has ended."""
        for key, one in self._current().items():
            if compare_digest(session.encode(errors="replace"), key.encode()):
                return one
        return None

    def _current(self) -> dict[str, Phone]:
        """Forget sessions that have ended, and return the others."""
        now = self._clock()
        self._phones = {key: one for key, one in self._phones.items() if one.until_s > now}
        return self._phones

    def _note_wrong(self, address: str, wrong: deque[float], now: float) -> None:
        wrong.append(now)
        self._wrong[address] = wrong
        self._wrong.move_to_end(address)
        while len(self._wrong) > MAX_ADDRESSES:
            self._wrong.popitem(last=False)


def qr_svg_uri(link: str) -> str:
    """Return the QR code of a link as a data URI of an SVG picture, black on white."""
    code = segno.make_qr(link, error="m")
    return code.svg_data_uri(border=4, dark="#000", light="#fff")


def qr_text(link: str) -> str:
    """Return the QR code of a link as lines for a terminal, white on black by escape codes."""
    out = io.StringIO()
    segno.make_qr(link, error="m").terminal(out, border=2, compact=True)
    return "\n".join(ON_BLACK.format(line) for line in out.getvalue().splitlines())
