"""Drawings of a design for your own figures: its section, and that of the mould it is cast in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pneutouch.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from pneutouch.parts import Assembly


def plot_section(assembly: Assembly, ax: Axes | None) -> Axes:
    """The hatched section of all bodies through the x axis, lengths in mm; returns the axes."""
    from pneutouch.report.section import draw_section

    ax = _axes(ax)
    draw_section(ax, assembly)
    return _scaled(ax)


def plot_mould(assembly: Assembly, ax: Axes | None, labels: bool) -> Axes:
    """One cavity of the closed mould in section, turned over as it is poured; returns the axes. Raises InputError."""
    from pneutouch.report.mould import draw_mould

    if assembly.mould is None:
        raise InputError(
            "the membrane is printed, not cast: it has no mould",
            key="profile",
            value=assembly.scene.design.print.profile,
            remedy='give a printer of moulds, such as profile="silicone-casting"',
        )
    ax = _axes(ax)
    draw_mould(ax, assembly.mould, labels)
    return _scaled(ax)


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    from matplotlib import pyplot

    made: Axes = pyplot.subplots()[1]
    return made


def _scaled(ax: Axes) -> Axes:
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.set(xlabel="x (mm)", ylabel="z (mm)")
    return ax
