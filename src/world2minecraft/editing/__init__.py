"""Editing of blocks and scenes with undo, clean-up of builds, and building into game worlds."""
