"""The environment on a game server, where a player moves and this program renders its view.

``body.mjs`` is the player program, which uses mineflayer and Node.js. ``player`` communicates with
it in JSON lines, and ``env`` is the Gymnasium environment.
"""
