"""Range of the law: stretches of the wall beyond those of its fit are a limit of the inflation and an event of the
press."""

from pneutouch.mechanics.events import Event
from pneutouch.mechanics.limits import LAW_RANGE
from pneutouch.mechanics.solid.indent import IndentationPath
from pneutouch.mechanics.solid.inflate import Inflation
from pneutouch.mechanics.solid.stress import StrainProbe, met


def leaves_law(probe: StrainProbe, run: Inflation, largest: float | None) -> tuple[float, float] | None:
    """Pressure (MPa) and outer apex height (mm) at which free inflation leaves the stretches of tension up to
    ``largest``; None if it does not, or where they are not known."""
    return None if largest is None else met(probe, run, probe.greatest_tension, largest)


def beyond_law(probe: StrainProbe, pressed: IndentationPath, largest: float | None) -> list[Event]:
    """The event of a wall pressed beyond the stretches that its law was fitted over; none where they are not known."""
    if largest is None:
        return []
    tension = [probe.greatest_tension(state.positions / probe.solid.length) for state in pressed.path]
    travel = [max(state.indentation, 0.0) for state in pressed.path]
    beyond = [at for at, stretch in zip(travel, tension, strict=True) if stretch > largest]
    if not beyond:
        return []
    text = (
        f"the wall is stretched up to the first invariant of tension to {max(tension):.2f} times the length, and its "
        f"law was fitted up to {largest:g}"
    )
    return [Event(LAW_RANGE, beyond[0], False, text)]
