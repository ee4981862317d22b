"""The program's own files and the formats of others that are not the game's.

Each module holds one file with its reader and its writer.
"""
