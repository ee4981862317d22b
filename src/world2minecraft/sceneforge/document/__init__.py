"""Documents: scenes on disk while they are edited, with snapshots, journal, recovery and saving."""
