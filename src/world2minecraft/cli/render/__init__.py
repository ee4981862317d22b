"""``w2m render``: pictures of any build."""
