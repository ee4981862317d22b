"""Measure how large shared pages are, and how soon they show the room.

    w2m share OUT -o room.html && python benchmarks/check_share.py room.html [MORE.html ...]

Opens each page from disk in a headless Chromium that draws by software, several times, and prints
the size of the file, and the time from the start of navigation to the first drawn frame: the best
and the median of all tries.
"""

import argparse
import shutil
import statistics
import sys
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
SIZES = ((1280, 720), (390, 844))
WAIT_MS = 30


def first_frame_ms(browser: Browser, page: Path, size: tuple[int, int]) -> float:
    """Open a page in a window of its own, and return when its first frame was drawn."""
    context = browser.new_context(viewport={"width": size[0], "height": size[1]})
    opened = context.new_page()
    opened.goto(page.resolve().as_uri())
    marked = "performance.getEntriesByName('room-first')[0]?.startTime"
    while (drawn := opened.evaluate(marked)) is None:
        opened.wait_for_timeout(WAIT_MS)
    context.close()
    return float(drawn)


def main() -> None:
    """Measure the pages that are named."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--tries", type=int, default=7)
    chosen = parser.parse_args()
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    with sync_playwright() as running:
        browser = running.chromium.launch(executable_path=program, args=list(ARGUMENTS))
        for page in chosen.pages:
            words = [f"{page.name}: {page.stat().st_size / 1e6:.2f} MB"]
            for size in SIZES:
                times = [first_frame_ms(browser, page, size) for _ in range(chosen.tries)]
                best, middle = min(times), statistics.median(times)
                words.append(f"{size[0]}x{size[1]} {best:.0f} / {middle:.0f} ms")
            sys.stdout.write(", ".join(words) + "\n")
        browser.close()


if __name__ == "__main__":
    main()
