"""A scene on disk while it is edited: snapshots, journal, recovery and saving."""
