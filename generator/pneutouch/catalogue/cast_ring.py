"""Check that a design can have a ring that its flange is cast around."""

from pneutouch.errors import InputError, shown
from pneutouch.spec.cast_ring import PerforatedRing
from pneutouch.spec.design import DesignFile
from pneutouch.spec.part import AnySeat, CastRing
from pneutouch.spec.printer import Printer


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
