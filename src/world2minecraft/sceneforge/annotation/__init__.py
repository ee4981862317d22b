"""The annotation page, on which people write navigation instructions for recorded walks."""
