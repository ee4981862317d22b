"""Commands: what data packs, command lists and RCON say, written and read."""
