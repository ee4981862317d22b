"""Labels of an image: which cells its region holds, and what the image shows of them."""
