"""Notes on a port for drawing, print sheet and datasheet."""

from pneutouch.catalogue import ResolvedDesign
from pneutouch.spec.part import Barb, Luer, PushIn, Thread


def port_note(scene: ResolvedDesign) -> str:
    """The note at the port in the drawing, diameters as drawn."""
    port, wider = scene.port, scene.hole_undersize
    if isinstance(port, Barb):
        return f"stem Ø{port.stem_diameter:g}\nbore Ø{port.bore_diameter:g}\nbarb Ø{port.barb_diameter:g}"
    if isinstance(port, Thread):
        return f"{port.thread}\ncore Ø{port.core_diameter + wider:.4g}\n{port.depth:g} deep"
    if isinstance(port, Luer):
        return f"Luer lock\nØ{port.opening_diameter + wider:.4g}, {port.taper:.0%}"
    return f"Ø{scene.tube.outer_diameter + wider:.4g}\n{port.depth:g} deep"


def port_steps(scene: ResolvedDesign) -> str:
    """Steps to clean and connect the port."""
    port, tube = scene.port, scene.tube
    size = f"{tube.outer_diameter:g} x {tube.inner_diameter:g} mm"
    if isinstance(port, Barb):
        behind = (
            f"; the mounting surface needs a hole of at least {tube.outer_diameter + 1:g} mm for it"
            if scene.mount.port_side == "rear"
            else ""
        )
        return (
            f"Port: push a {port.bore_diameter:g} mm drill or wire through the bore. Push {size} soft tube over the "
            f"barb{behind}."
        )
    if isinstance(port, Thread):
        return (
            f"Port: drill the core hole to {port.core_diameter:g} mm, tap {port.thread}; screw the fitting in by hand "
            "until its gasket lies on the face."
        )
    if isinstance(port, Luer):
        return (
            "Port: clear the cone of support; check with a male Luer lock that it grips by the cone before the lock "
            "bottoms."
        )
    assert isinstance(port, PushIn)
    return f"Port: push {size} tube in to the stop, {port.depth:g} mm deep, and glue it in."
