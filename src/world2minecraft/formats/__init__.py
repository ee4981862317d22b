"""Readers and writers of the program's own files and of foreign formats that are not the game's."""
