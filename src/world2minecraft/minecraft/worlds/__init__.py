"""World folders and region files: reading, writing, in-place editing and installation."""
