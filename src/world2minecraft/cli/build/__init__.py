"""The verb ``w2m build``, which builds a room from blocks."""
