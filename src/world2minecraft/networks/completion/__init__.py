"""The completion network: virtual scans to learn from, the network, its training and export.

Samples are made without torch; see docs/completion.md for the commands.
"""
