"""The ``/api/live`` websocket, which receives requests of a browser tab and sends it changes.

The messages are those in ``wire.ts``. Each request is answered with ``done`` or ``refused`` and the
number that the tab assigned to it. A change is sent to every tab before the request that caused it
is answered with ``done``.
"""

import asyncio
from collections.abc import Mapping
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from world2minecraft.core.errors import UsageError, World2MinecraftError
from world2minecraft.sceneforge.broadcast import Tab, to_json_text
from world2minecraft.sceneforge.server.error_messages import explain_error
from world2minecraft.sceneforge.server.limits import parse_json
from world2minecraft.sceneforge.session import Session

TOO_MANY = 1013  # The websocket code for "try again later".


async def live(socket: WebSocket) -> None:
    """Serve one browser tab until it disconnects."""
    session: Session = socket.app.state.session
    tab = session.broadcaster.open()
    if tab is None:
        await socket.close(TOO_MANY, "too many open tabs; close some")
        return
    sender = None
    try:
        await socket.accept()
        running = [one for one in session.jobs.states() if one["state"] == "running"]
        for message in (session.hello(), *running):  # Of those that ended GET /api/jobs tells.
            tab.put(to_json_text(message))
        sender = asyncio.create_task(_send(socket, tab, session))
        while True:
            await _answer(await socket.receive(), tab, session)
    except WebSocketDisconnect:
        return
    finally:
        session.broadcaster.close(tab)
        if sender is not None:
            sender.cancel()


async def _send(socket: WebSocket, tab: Tab, session: Session) -> None:
    """Send the queued messages until the socket is closed."""
    try:
        while True:
            await socket.send_text(await tab.get(session.hello))
    except (WebSocketDisconnect, RuntimeError):
        return


async def _answer(received: Mapping[str, Any], tab: Tab, session: Session) -> None:
    """Process one message, and send its result or the reason for its failure to the tab."""
    if received["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(received.get("code", 1005))
    message: Any = None
    try:
        message = parse_json(received.get("text") or received.get("bytes") or b"")
        if not isinstance(message, dict):
            raise UsageError('a message must be a JSON object with a "type" field')
        if await _do(message, tab, session):
            tab.put(to_json_text({"type": "done", "seq": _seq(message), "rev": session.rev}))
    except Exception as error:
        if not isinstance(error, World2MinecraftError):
            session.report(error)
        text = explain_error(error)
        tab.put(to_json_text({"type": "refused", "seq": _seq(message), "error": text}))


async def _do(message: dict[str, Any], tab: Tab, session: Session) -> bool:
    """Process a message, and return whether it is answered."""
    kind = message.get("type")
    if kind == "active":
        await session.active(tab.actor)
        return False
    if kind == "cancel":
        await asyncio.to_thread(session.jobs.cancel, str(message.get("job")))
        return False
    if kind == "do":
        await session.do(message.get("command"), tab.actor)
    elif kind == "undo":
        await session.undo(tab.actor)
    elif kind == "redo":
        await session.redo(tab.actor)
    elif kind == "save":
        await session.save()
    else:
        raise UsageError(f"unknown message type {str(kind)[:40]!r}")
    return True


def _seq(message: Any) -> int:
    seq = message.get("seq") if isinstance(message, dict) else None
    return seq if isinstance(seq, int) else -1
