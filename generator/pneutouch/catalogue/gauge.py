"""The pressure gauge that a design names."""

from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError
from pneutouch.spec.design import DesignFile
from pneutouch.spec.gauge import Gauge


def named_gauge(design: DesignFile, where: str, library: Library) -> Gauge | None:
    """The gauge of a design, None without one. Raises InputError if it does not read above the ambient pressure."""
    name, ambient_kPa = design.pneumatics.gauge, design.pneumatics.ambient_pressure_kPa
    if name is None:
        return None
    gauge: Gauge = library.load("gauges", name, file=where, key="pneumatics.gauge")
    if gauge.gauge_pressures_kPa(ambient_kPa)[1] <= 0:
        raise InputError(
            f"the {gauge.title} reads to {gauge.range_kPa.high:g} kPa absolute, not above the ambient "
            f"{ambient_kPa:g} kPa",
            file=where,
            key="pneumatics.gauge",
            value=name,
            remedy="take another gauge",
        )
    return gauge
