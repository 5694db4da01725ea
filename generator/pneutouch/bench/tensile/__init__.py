"""Laws fitted to tension: a measured curve of nominal stress over stretch in, a hyperelastic law with its misfit out."""
