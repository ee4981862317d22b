"""A running server: the RCON protocol, and building a volume through it."""
