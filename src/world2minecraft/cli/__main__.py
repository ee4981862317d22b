"""``python -m world2minecraft.cli`` does what ``w2m`` does."""

from world2minecraft.cli import main

if __name__ == "__main__":
    main()
