"""Automatic clean-up of built rooms. Each repair is an edit that can be undone."""
