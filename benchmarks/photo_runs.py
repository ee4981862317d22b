"""``w2m`` with the stereo of a rival in place of ours: ``photo_runs ours|sgbm WORDS...``."""

import sys

from world2minecraft.cli import run


def main() -> int:
    """Run the command."""
    which, *words = sys.argv[1:]
    if which == "sgbm":
        from benchmarks import rival_sgbm
        from world2minecraft.prepare import preparing

        preparing.depth_maps = rival_sgbm.depth_maps
    return run(words)


if __name__ == "__main__":
    sys.exit(main())
