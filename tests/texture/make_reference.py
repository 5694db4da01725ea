"""Makes reference.json: Morse transforms by ssqueezepy 0.6.6 (MIT), to hold ours against.

Run it in an environment of its own, as it brings numba and llvmlite (some 200 MB):

    python -m venv /tmp/reference && /tmp/reference/bin/pip install ssqueezepy==0.6.6
    /tmp/reference/bin/python tests/texture/make_reference.py
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

RATE, COUNT = 50.0, 1500
FREQUENCY = 0.5 * 2 ** (np.arange(29, -1, -1) / 10)
"""Falling: ssqueezepy wants rising scales."""
AT = np.arange(450, 1051, 60)
"""Samples compared: mid-record, where what stands beyond the ends, which the two pad by different lengths, does not reach."""


def values() -> np.ndarray:
    """Two tones, a chirp and a step, so that every voice has something to read."""
    t = np.arange(COUNT) / RATE
    tones = 0.7 * np.cos(2 * np.pi * 0.75 * t) + 0.3 * np.cos(2 * np.pi * 1.5 * t + 1)
    return tones + 0.2 * np.cos(2 * np.pi * (0.8 * t + 0.04 * t**2)) + 0.5 * (t > 14.5)


def main() -> None:
    import ssqueezepy

    scales = (20 / 3) ** (1 / 3) * RATE / (2 * np.pi * FREQUENCY)
    wavelet = ("gmw", {"gamma": 3, "beta": 20, "norm": "bandpass", "dtype": "float64"})
    found, *_ = ssqueezepy.cwt(values(), wavelet, scales=scales, fs=RATE, l1_norm=True, padtype="reflect")
    kept = found[:, AT]
    content = {
        "made by": f"ssqueezepy {ssqueezepy.__version__}, numpy {np.__version__}, tests/texture/make_reference.py",
        "real": kept.real.tolist(),
        "imaginary": kept.imag.tolist(),
    }
    Path(__file__).with_name("reference.json").write_text(json.dumps(content) + "\n")


if __name__ == "__main__":
    main()
