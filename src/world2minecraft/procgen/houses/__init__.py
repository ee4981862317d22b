"""Houses of several rooms: floor plans, stairs, and their rooms furnished."""
