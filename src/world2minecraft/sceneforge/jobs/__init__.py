"""Long-running work of the editor, in background threads and processes."""
