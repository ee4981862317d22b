"""Run ``w2m`` with ``python -m world2minecraft``."""

from world2minecraft.cli import main

if __name__ == "__main__":
    main()
