"""Scans over textured specimens, wavelet spectra of the pressure, and detection of patterns in them."""
