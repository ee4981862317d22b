"""Labels of an image: the contents of the cells in its region, and which of them are visible."""
