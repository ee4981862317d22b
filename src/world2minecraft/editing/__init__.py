"""Edits of blocks: done, undone, kept in a journal; clean-up; building into a user's world."""
