"""Opens a link that a verb printed in the user's browser."""

import threading
import webbrowser
from pathlib import PurePath

# They would take the terminal, where the link and what follows it are to be read.
IN_THE_TERMINAL = frozenset({"www-browser", "links", "elinks", "lynx", "w3m"})


def open_link(link: str) -> None:
    """Open a link and return at once; where there is no browser it stands in the terminal.

    Some browsers keep whoever opens them waiting until they end; a server cannot.
    """
    if not _is_in_the_terminal():
        threading.Thread(target=webbrowser.open, args=[link], daemon=True).start()


def _is_in_the_terminal() -> bool:
    try:
        name = getattr(webbrowser.get(), "name", "")
    except webbrowser.Error:
        return False
    return PurePath(str(name)).name in IN_THE_TERMINAL
