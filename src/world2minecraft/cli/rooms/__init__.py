"""``w2m rooms``: generated rooms and virtual scans of them."""
