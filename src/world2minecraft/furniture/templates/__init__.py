"""One template a file; each is named in the registry of ``furniture``."""
