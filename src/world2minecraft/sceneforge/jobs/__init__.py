"""Long work of the editor, in threads and processes beside it."""
