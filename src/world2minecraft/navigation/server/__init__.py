"""A player on a running server as the body of the environment; its eyes are our renderer.

``body.mjs`` is the player's program, by mineflayer and Node; ``player`` talks to it by lines of
JSON, and ``env`` is the environment.
"""
