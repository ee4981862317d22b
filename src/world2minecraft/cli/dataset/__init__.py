"""``w2m dataset``: build, look at, check, import and export data sets."""
