"""Undoable edits of scenes and game worlds, and the clean-up of builds."""
