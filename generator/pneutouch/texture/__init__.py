"""Scans over textured specimens and the wavelet spectra of their pressure."""
