"""Laws from tensile tests: curves of nominal stress over stretch, and the hyperelastic law fitted to them."""
