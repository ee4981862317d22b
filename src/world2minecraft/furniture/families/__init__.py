"""The shapes of furniture, as metric parts and as vanilla blocks; ``family.py`` names each."""
