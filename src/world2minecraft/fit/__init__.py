"""Shape fitting: fine occupancy to block states, object by object."""
