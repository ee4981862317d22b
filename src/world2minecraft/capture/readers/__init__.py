"""Readers: one module for each kind of capture, from its files to frames."""
