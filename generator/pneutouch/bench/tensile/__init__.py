"""Laws fitted to tension: a curve of nominal stress over stretch in, a hyperelastic law with its misfit out."""
