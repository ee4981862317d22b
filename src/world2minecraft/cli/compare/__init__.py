"""``w2m compare``: layouts of other methods beside ours."""
