"""``w2m forge``: the web editor."""
