"""The CPU ray caster: compiled kernels from rays through blocks to shaded pixels."""
