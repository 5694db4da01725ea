"""
How is a tensile test turned into a material?
=============================================

``pt.fit_material`` fits a hyperelastic law to a laboratory's own tensile test. The test here is synthetic: a neo-
Hookean rubber of 0.2 MPa with noise, written by this example. The fit must return that modulus.
"""

import os
import tempfile
from pathlib import Path
from unittest import mock

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("cast-dome")
true_MPa = 0.2
stretch = np.linspace(1, 2.2, 60)
noise_MPa = np.random.default_rng(1).normal(0, 0.002, stretch.size)
stress_MPa = np.where(stretch > 1, true_MPa * (stretch - stretch**-2) + noise_MPa, 0.0)

with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, PNEUTOUCH_HOME=folder):
    file = Path(folder) / "synthetic.csv"
    rows = [f"{strain:.5f},{stress:.6f}" for strain, stress in zip(stretch - 1, stress_MPa, strict=True)]
    file.write_text("\n".join(["Engineering Strain,Engineering Stress (MPa)", *rows]), encoding="utf-8")
    fitted = pt.fit_material(file, "OurRubber", like="DragonSkin20")
    fitted.save(folder)
    state = design.replace(material="OurRubber").predict([0], model="atlas").at(0)

modulus_MPa = fitted["shear_modulus_MPa"]
print(f"True modulus of the synthetic test: {true_MPa:.3f} MPa; fitted: {modulus_MPa:.4f} MPa.")
print(f"The cast dome in this rubber has {state.sensitivity_kPa_per_N:.2f} kPa/N.")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(stretch, stress_MPa, "o", color="0.5", mfc="none", ms=4, label="synthetic tensile test")
axes.plot(stretch, modulus_MPa * (stretch - stretch**-2), "k-", label=f"fitted, {modulus_MPa:.3f} MPa")
axes.set(xlabel="stretch (-)", ylabel="nominal stress (MPa)", xlim=(1, None), ylim=(0, None))
axes.legend()
