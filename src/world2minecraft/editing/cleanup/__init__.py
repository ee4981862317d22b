"""Automatic clean-up of built rooms: each repair is an edit that can be undone."""
