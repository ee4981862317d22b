"""The game: block states, their shapes, and its file formats, read and written."""
