"""World folders and regions: read, written, edited in place, and where the game keeps them."""
