"""Virtual sensors: depth cameras, phones, photos and the ways that people hold them."""
