"""Scans over textured specimens, and wavelet spectra of the measured pressure."""
