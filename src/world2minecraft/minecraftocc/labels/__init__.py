"""Labels of an image: what the cells of its region hold, and what the image shows of them."""
