"""Parts of the connector that a design names in more than one key: its tube and its mount.

The pressure gauge that a design names.

Check that a design can have a ring that its flange is cast around.
"""

from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError, shown
from pneutouch.spec.design import DesignFile
from pneutouch.spec.gauge import Gauge
from pneutouch.spec.part import AnyMount, AnySeat, CastRing, PerforatedRing, Sleeve, Tube
from pneutouch.spec.printer import Printer


def tube_of(design: DesignFile, where: str, library: Library) -> Tube:
    """The tube that the design names, else the usual one of its port. Raises InputError if it does not fit."""
    port = library.load("ports", design.connector.port, file=where, key="connector.port")
    name = design.pneumatics.tube
    if name is not None:
        library.load("tubes", name, file=where, key="pneumatics.tube")
        if name not in port.tubes:
            raise InputError(
                f"the port {design.connector.port} takes {', '.join(port.tubes)}",
                file=where,
                key="pneumatics.tube",
                value=name,
                remedy="give one of these, or another connector.port",
            )
    tube: Tube = library.load("tubes", name or port.tubes[0], file=where, key="tubes of connector.port")
    return tube


def mount_of(design: DesignFile, where: str, library: Library) -> AnyMount:
    """The mount that the design names; a sleeve for the finger that it gives."""
    chosen, finger = design.connector.mount, design.connector.finger_diameter_mm
    mount: AnyMount = library.load("mounts", chosen, file=where, key="connector.mount")
    if finger is None:
        return mount
    if not isinstance(mount, Sleeve):
        sleeves = [name for name in library.paths("mounts") if isinstance(library.load("mounts", name), Sleeve)]
        raise InputError(
            f"connector.mount = {shown(chosen)} goes over no finger",
            file=where,
            key="connector.finger_diameter_mm",
            value=finger,
            remedy=f"take connector.mount = {' or '.join(sleeves)}, or leave it out",
        )
    return mount.for_finger(finger)


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


def check_cast_ring(design: DesignFile, where: str, seat: AnySeat, printer: Printer) -> None:
    """Raise InputError for a ring around which nothing is cast, or a ring stated for a seat without one.

    ``printer`` is that of the membrane, ``where`` the design's file.
    """
    chosen = design.connector.seat
    if not isinstance(seat, CastRing):
        if design.cast_ring != PerforatedRing():
            problem = f"connector.seat = {shown(chosen)} has no ring that a flange is cast around"
            remedy = "leave the table out, or take connector.seat = cast-ring"
            raise InputError(problem, file=where, key="cast_ring", remedy=remedy)
        return
    if not printer.is_casting:
        raise InputError(
            f"the flange is cast around its ring; print.profile = {shown(design.print.profile)} prints the membrane",
            file=where,
            key="connector.seat",
            value=chosen,
            remedy="take print.profile = silicone-casting with a membrane.material that is cast, or another seat",
        )
