"""One-line error messages for the page and for scripts."""

import errno

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from world2minecraft.core.errors import World2MinecraftError, one_line


def explain_error(error: BaseException) -> str:
    """Return a one-line message that states the problem or what to do about it."""
    if isinstance(error, World2MinecraftError):
        return one_line(error)
    if isinstance(error, MemoryError):
        return "out of memory; close other programs and try again"
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return "the disk is full; free some space and try again"
    return f"unexpected {type(error).__name__}; see the terminal of w2m forge for details"


async def _usage_error(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": explain_error(error)}, 400)


async def _http(request: Request, error: Exception) -> Response:
    status, detail = getattr(error, "status_code", 500), getattr(error, "detail", "")
    return JSONResponse({"error": detail}, status, getattr(error, "headers", None))


async def _unexpected_error(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": explain_error(error)}, 500)


# How an application answers, whatever goes wrong: JSON with one line.
EXCEPTION_HANDLERS = {
    World2MinecraftError: _usage_error,
    HTTPException: _http,
    Exception: _unexpected_error,
}
