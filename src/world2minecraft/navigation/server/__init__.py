"""A player on a running server as the body of the environment; its eyes are our renderer.

``body.mjs`` is the player, by mineflayer and Node; ``bridge`` talks to it by lines of JSON,
``body`` makes values of what it says, and ``env`` is the environment.
"""
