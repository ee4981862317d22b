"""The guard of a restructuring: what the program writes, held against that of an older commit.

``declared`` says what was renamed and what differs by nature, ``table`` which commands are run,
``acting`` what is done besides plain commands, ``running`` runs them with the code of each side,
``contents`` compares the files and ``nbt`` reads what the game's files hold. Nothing here imports
the package that it compares.
"""
