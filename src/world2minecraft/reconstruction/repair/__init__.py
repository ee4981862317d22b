"""Repair by rendering: other furniture for objects that compare badly with the photos."""
