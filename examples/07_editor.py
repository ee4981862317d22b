"""Open the web editor for a room, and wait until you press Enter.

python examples/07_editor.py [OUT]
"""

import sys

import world2minecraft as w2m

source = sys.argv[1] if len(sys.argv) > 1 else "OUT"

with w2m.open_editor(source, browser=sys.stdin.isatty()) as editor:
    print("SceneForge:", editor.link)
    if sys.stdin.isatty():
        input("Press Enter to stop; every edit is saved. ")
