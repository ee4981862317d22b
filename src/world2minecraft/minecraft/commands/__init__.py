"""Reading and writing of game commands for data packs, command lists and RCON."""
