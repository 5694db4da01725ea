"""What a datasheet says, as plain data: both the page and the PDF are set from it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from pneutouch import __version__
from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.chart_data import TradeOff, TuningChart
from pneutouch.mechanics import SensorPrediction
from pneutouch.mechanics.limits import RATED_SHARE
from pneutouch.mechanics.prediction import SensorState
from pneutouch.parts import Assembly
from pneutouch.printability import Finding
from pneutouch.printability.estimate import JobEstimate
from pneutouch.report import ordering, prose
from pneutouch.report.certainty import how_sure, interval
from pneutouch.report.environment import NOT_TESTED, environment
from pneutouch.spec.material import Material
from pneutouch.units import KPA, ML

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty import GasNotes

DASH = "–"


@dataclass(frozen=True)
class Datasheet:
    """Everything a datasheet is made from.

    Attributes:
        scene: The design with its names resolved.
        assembly: Its bodies.
        prediction: Its figures.
        findings: What the print rules say.
        input_hash: Of everything the sheet follows from.
        resins: Materials to compare with.
        estimates: What each print job takes.
        uncertainty: One document a state, as `Evaluation.uncertainty`.
        gas: What the air does, one entry a state; None where the atlas does not know.
        tradeoff: What the design is set in; None where the atlas does not know.
        tuning: Its sensitivity over the driving pressure; None where the atlas does not know.
        published_kPa_per_N: Published sensitivities of this sensor by driving pressure, kPa.
    """

    scene: ResolvedDesign
    assembly: Assembly
    prediction: SensorPrediction
    findings: list[Finding]
    input_hash: str
    resins: dict[str, Material]
    uncertainty: tuple[dict[str, Any], ...]
    estimates: tuple[JobEstimate, ...] = ()
    gas: GasNotes | None = None
    tradeoff: TradeOff | None = None
    tuning: TuningChart | None = None
    published_kPa_per_N: Mapping[float, float] = field(default_factory=dict)

    def content(self) -> dict[str, Any]:
        """The sections of the sheet; every leaf is text, ready to be printed."""
        document = self.scene.design.document
        return {
            "title": document.title,
            "name": self.scene.name,
            "part_number": ordering.part_number(self.scene),
            "revision": document.revision,
            "date": document.date.isoformat() if document.date else "undated",
            "tool": f"pneutouch {__version__}",
            "input_hash": self.input_hash,
            "status": "Predicted. No unit has been built or tested.",
            "description": prose.description(self.scene),
            "limits_of_use": prose.LIMITS_OF_USE,
            "key_figures": self.key_figures(),
            "ratings": self.ratings(),
            "operating": self.operating(),
            "performance": self.performance(),
            "model_error": self.model_error(),
            "how_sure": how_sure(self.prediction, self.uncertainty),
            "captions": self.captions(),
            "limits": self.limits(),
            "environment": environment(self.scene, self.prediction, self.gas),
            "reliability": [[what, NOT_TESTED] for what in prose.RELIABILITY],
            "bodies": self.bodies(),
            "printing": prose.printing(self.scene),
            "method": prose.method(self.scene),
            "ordering": ordering.code_table(self.scene),
            "handling": prose.HANDLING,
            "definitions": prose.DEFINITIONS,
            "assumptions": list(self.prediction.assumptions),
            "findings": [[f.severity, f.rule, f.message, f.fix] for f in self.findings],
            "sources": self.sources(),
            "revisions": [[document.revision, document.date.isoformat() if document.date else "undated", "As predicted; first issue of this revision."]],
        }  # fmt: skip

    def key_figures(self) -> list[list[str]]:
        """Tiles of the first page: name, value, unit, condition."""
        first, last = self.prediction.states[0], self.prediction.states[-1]
        limits = self.prediction.limits
        mass = sum(solid.mass for solid in self.assembly.solids)
        wide = 2 * self.assembly.layout.plate_radius
        return [
            ["Sensitivity", _sensitivity(first), "kPa/N", self._sure(0)],
            ["Sensitivity", _sensitivity(last), "kPa/N", self._sure(-1)],
            ["Force range", _range(last), "N", f"at {last.driving_pressure / KPA:g} kPa"],
            [
                "Max. driving pressure",
                f"{self.rated_pressure_kPa():.1f}",
                "kPa",
                f"{RATED_SHARE:.0%} of the {limits.binding}",
            ],
            ["Dead volume", f"{self.prediction.dead_volume / ML:.2f}", "mL", "behind the cavity"],
            ["Size", f"Ø{wide:.1f}", "mm", f"{mass:.1f} g without tube"],
        ]

    def _sure(self, k: int) -> str:
        """Condition and interval of a state's sensitivity."""
        width = interval(self.uncertainty[k])
        said = f"{width} (k = 2)" if width else "interval not known, see How sure"
        return f"at {self.prediction.states[k].driving_pressure / KPA:g} kPa; {said}"

    def captions(self) -> dict[str, str]:
        """Captions of the figures that depend on the prediction, and words in the place of those left out."""
        why = next((document["unknown"] for document in self.uncertainty if "unknown" in document), "no figures there")
        absent = f"Trade-off and tuning charts are not drawn: {why}."
        chart = self.tradeoff
        return {
            "tradeoff": absent
            if chart is None
            else prose.tradeoff(chart.driving_pressure_kPa, self.prediction.dead_volume / ML),
            "tuning": "" if self.tuning is None else prose.TUNING,
            "shapes": prose.SHAPES if self.prediction.states[0].shapes else prose.NO_SHAPES,
        }

    def ratings(self) -> list[list[str]]:
        """Absolute maximum ratings: quantity, value, unit, basis."""
        limits = self.prediction.limits
        basis = (
            f"{RATED_SHARE:.0%} of the {limits.binding} ({limits.lowest / KPA:.2f} kPa, model {self.prediction.model})"
        )
        return [
            ["Driving pressure", f"{self.rated_pressure_kPa():.1f}", "kPa gauge", basis],
            ["Cavity pressure while pressed", DASH, "kPa gauge", f"{NOT_TESTED}; the pressure sensor (SMC PSE543-R06) reads to 100 kPa"],
            ["Overload force", DASH, "N", NOT_TESTED],
            ["Burst pressure", DASH, "kPa", NOT_TESTED],
            ["Temperature", DASH, "°C", NOT_TESTED + "; the paper's tests ran at 18 to 26 °C"],
        ]  # fmt: skip

    def rated_pressure_kPa(self) -> float:
        """Greatest driving pressure to be used, kPa, rounded down: a share of the limit that binds."""
        return math.floor(10 * RATED_SHARE * self.prediction.limits.lowest / KPA) / 10

    def operating(self) -> list[list[str]]:
        """Operating conditions that the figures hold for."""
        design = self.scene.design
        pressures = ", ".join(f"{p:g}" for p in design.pneumatics.driving_pressures_kPa)
        stated = "stated in the design" if design.pneumatics.dead_volume_mL is not None else (
            f"connector {self.assembly.internal_volume / ML:.3f} mL and {design.pneumatics.tube_length_mm:g} mm of "
            f"{self.scene.tube.outer_diameter:g} x {self.scene.tube.inner_diameter:g} mm tube"
        )  # fmt: skip
        return [
            ["Driving pressure", pressures, "kPa gauge", "before contact"],
            ["Medium", "air", "", "trapped, isothermal"],
            ["Ambient pressure", f"{design.pneumatics.ambient_pressure_kPa:g}", "kPa", "absolute"],
            ["Dead volume", f"{self.prediction.dead_volume / ML:.3f}", "mL", stated],
            ["Contact body", f"Ø{design.indentation.plate_diameter_mm:g}", "mm", "rigid, flat, frictionless plate"],
            [
                "Indentation",
                f"0 to {design.depth_mm:.2f}",
                "mm",
                f"{design.indentation.steps} steps from first contact",
            ],
        ]

    def performance(self) -> list[list[str]]:
        """One row a driving pressure."""
        return [
            [
                f"{s.driving_pressure / KPA:g}", f"{s.apex_inner:.2f}", f"{s.apex_outer:.2f}", _sensitivity(s),
                interval(sure) or DASH, self._published(s.driving_pressure / KPA), f"{s.figures.r_squared:.4f}" if s.figures else DASH,
                f"{100 * s.figures.nonlinearity:.1f}" if s.figures else DASH,
                f"{s.figures.stiffness:.2f}" if s.figures else DASH, _range(s), _ends(s),
            ]
            for s, sure in zip(self.prediction.states, self.uncertainty, strict=True)
        ]  # fmt: skip

    def _published(self, pressure: float) -> str:
        value = self.published_kPa_per_N.get(round(pressure, 9))
        return DASH if value is None else f"{value:.3f}"

    def model_error(self) -> list[str]:
        """Sentences on how far the model is off."""
        return list(self.prediction.error_estimate["summary"])

    def limits(self) -> list[list[str]]:
        """The three limits of the driving pressure and which of them binds."""
        limits, point = self.prediction.limits, self.prediction.limit_point
        broken = DASH if limits.break_strain is None else f"{limits.break_strain / KPA:.1f}"
        where = "the resin's least elongation at break" + ("; not met before the limit point" if broken == DASH else "")
        reach = "none: the pressure goes on rising" if point is None else (
            f"dome snaps at {point.apex_inner:.2f} mm inside, {point.apex_outer:.2f} mm outside"
        )  # fmt: skip
        peak = DASH if limits.limit_point is None else f"{limits.limit_point / KPA:.2f}"
        rows = [
            ["limit point", peak, reach],
            ["break strain", broken, where],
            ["gauge range", f"{limits.gauge / KPA:g}", "pressure sensor of ±100 kPa"],
        ]  # fmt: skip
        return [[*row, "binds" if row[0] == limits.binding else ""] for row in rows]

    def bodies(self) -> list[list[str]]:
        """Material and print of each body."""
        rows = []
        for solid in self.assembly.solids:
            printer, mode = self.assembly.machine(solid.name)
            rows.append([
                solid.name, solid.material.label, f"{solid.volume / ML:.3f} mL, {solid.mass:.2f} g",
                f"{printer.title}, {mode.name}, {mode.layer_height_um:g} µm", printer.support,
            ])  # fmt: skip
        return rows

    def sources(self) -> list[list[str]]:
        """Where the resin's numbers come from: quantity, value, source."""
        m = self.scene.membrane_material
        entries = [
            ("Shear modulus, MPa", m.shear_modulus_MPa), ("Poisson ratio", m.poisson_ratio),
            ("Density, g/cm³", m.density_g_per_cm3), ("Shore A", m.shore_a),
            ("Tensile strength, MPa", m.tensile_strength_MPa), ("Elongation at break, %", m.elongation_at_break_percent),
        ]  # fmt: skip
        rows = [[what, quantity.text(), quantity.source] for what, quantity in entries if quantity is not None]
        if m.measured is not None:
            rows.append(
                ["Hysteresis at 0 kPa, %", m.measured.hysteresis_percent.text(), m.measured.hysteresis_percent.source]
            )
        accuracy = self.scene.printer.accuracy_mm
        return [
            ["The paper", "", prose.PAPER],
            *rows,
            [f"Accuracy of the {self.scene.printer.title}, mm", f"±{accuracy.nominal:g}", accuracy.source],
        ]


def _sensitivity(state: SensorState) -> str:
    return f"{state.figures.sensitivity_kPa_per_N:.2f}" if state.figures else DASH


def _range(state: SensorState) -> str:
    return f"0 to {state.figures.force_range[1]:.1f}" if state.figures else DASH


def _ends(state: SensorState) -> str:
    kinds = [event.kind for event in state.events if event.ends_range]
    return f"{kinds[0] if kinds else 'depth'}, {state.range_end:.2f} mm"
