"""The furniture families, as metric parts and vanilla blocks; ``family.py`` defines ``Family``."""
