"""Access control for the phone page, which listens on the local network.

Each request must name exactly the shown address (``Host``) and come from the page itself or from
no page (``Origin``, ``Sec-Fetch-Site``). A request that changes something must say that it comes
from the page. Beyond the page's own files and the exchange of a code, it must bring the cookie of
a phone. There is no token for programs and no websocket.
"""

from urllib.parse import urlsplit

from starlette.types import ASGIApp, Receive, Scope, Send

from world2minecraft.sceneforge.phone_access import Phone, PhoneAccess
from world2minecraft.sceneforge.server.guard import (
    ALONE,
    HEADERS,
    cookie_value,
    foreign_reason,
    headers_of,
    refuse,
    with_headers,
)
from world2minecraft.sceneforge.server.limits import drain

PAIR = "/api/phone/pair"
PUBLIC = frozenset({"/", "/phone.js", "/phone.css", PAIR})  # What a phone sees before it is let in.
SCAN_AGAIN = "this phone is not connected; scan the code on the computer's screen"
READING = frozenset({"GET", "HEAD"})


class PhoneGuard:
    """The outermost ASGI middleware of the phone page. It stores the phone in the scope.

    Args:
        app: The ASGI application to protect.
        access: The codes and sessions. Its URL is the only one that is served.
    """

    def __init__(self, app: ASGIApp, access: PhoneAccess):
        self.app, self.access = app, access
        parts = urlsplit(access.url)
        self.scheme, self.host = parts.scheme, parts.netloc.lower()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on to the application, or refuse it with a status and a reason."""
        headers = headers_of(scope)
        send = with_headers(scope, send, (*HEADERS, *ALONE))
        refusal, status = self._foreign(scope, headers), 403
        phone = None if refusal else self._phone(headers)
        if not refusal and phone is None and scope["path"] not in PUBLIC:
            refusal, status = SCAN_AGAIN, 401
        if not refusal:
            await self.app({**scope, "phone": phone}, receive, send)
            return
        if scope["type"] == "http":
            await drain(receive)  # A phone that still sends would see a reset, and try again.
        await refuse(scope, receive, send, refusal, status)

    def _foreign(self, scope: Scope, headers: dict[str, list[str]]) -> str:
        if scope["type"] != "http":
            return "the phone page has no websocket"
        if scope["method"] not in READING and "origin" not in headers:
            return "requests from outside the phone page are not allowed"
        return foreign_reason(headers, lambda host: host == self.host, schemes=(self.scheme,))

    def _phone(self, headers: dict[str, list[str]]) -> Phone | None:
        name = cookie_name(self.access)
        found = (self.access.phone(cookie_value(one, name)) for one in headers.get("cookie", []))
        return next((one for one in found if one is not None), None)


def cookie_name(access: PhoneAccess) -> str:
    """Return the name of the cookie, in which the port tells two servers apart."""
    return f"w2m_phone_{urlsplit(access.url).port}"
