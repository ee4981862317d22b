"""Open links in the user's browser."""

import threading
import webbrowser
from pathlib import PurePath

# Text browsers would take over the terminal that shows the link.
IN_THE_TERMINAL = frozenset({"www-browser", "links", "elinks", "lynx", "w3m"})


def open_link(link: str) -> None:
    """Open a link in the browser, without waiting for browsers that block until they are closed.

    The link is not opened if only a text browser is available.
    """
    if not _is_in_the_terminal():
        threading.Thread(target=webbrowser.open, args=[link], daemon=True).start()


def _is_in_the_terminal() -> bool:
    try:
        name = getattr(webbrowser.get(), "name", "")
    except webbrowser.Error:
        return False
    return PurePath(str(name)).name in IN_THE_TERMINAL
