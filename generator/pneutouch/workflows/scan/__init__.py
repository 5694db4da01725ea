"""A texture scanned by a sensor, and domes that separate two textures."""
