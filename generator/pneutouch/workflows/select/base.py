"""Base of a selection: the design that gives everything that the target does not.

Also the pair of base resins to mix: resolved, checked against the printer, and offered to the search as resins."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import read_given
from pneutouch.catalogue.mixture import ResolvedMixingCurve, mixed_material, mixing
from pneutouch.catalogue.printers import casting_missing, made_by, makers, uncast
from pneutouch.errors import InputError, PneutouchError, shown
from pneutouch.evaluation.contact_object import check_shape
from pneutouch.mechanics.atlas.coverage import resin_outside_atlas
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.output.new import PRINTED_PORT
from pneutouch.parts import assemble
from pneutouch.selection.mixes import levels
from pneutouch.selection.problem import CandidateResin
from pneutouch.spec.design import CALIBRATION, DesignFile
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.part import OnePiece, Sleeve
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import Changes, parse_changes, validate
from pneutouch.spec.target import Shelf, Target
from pneutouch.wording import data_of

USUAL = "TangoPlus+VeroClear"
"""Pair of resins for a grade if none is named: the paper's."""


@dataclass(frozen=True)
class ResinPair:
    """A soft and a stiff resin with their mixing curve; ``where`` names the target's file in messages."""

    soft: str
    stiff: str
    law: ResolvedMixingCurve
    library: Library
    where: str

    @property
    def name(self) -> str:
        """``SOFT+STIFF``, as a target names it."""
        return f"{self.soft}+{self.stiff}"

    def grade(self, *fractions: float) -> Grade:
        """Constant mix if one fraction is given, else a grade of fractions at even knots from the pole to the rim."""
        value = fractions[0] if len(fractions) == 1 else list(fractions)
        return Grade.model_validate({"from": self.soft, "to": self.stiff, "fraction": value})

    def material(self, grade: Grade) -> Material:
        """The material of a grade."""
        return mixed_material(grade, self.library, file=self.where)

    def resin(self, fraction: float) -> CandidateResin:
        """A constant mix as a candidate resin of the search."""
        grade = self.grade(fraction)
        return CandidateResin.of(grade.label, self.material(grade), grade)


def pair_of(name: str, printer: Printer, library: Library, where: str, named: bool = True) -> ResinPair:
    """Pair of resins from ``SOFT+STIFF``. Raises InputError if a name is unknown or the printer cannot mix the two.

    ``named`` is True if the user named the pair."""
    soft, stiff = (part.strip() for part in name.split("+"))
    pair = ResinPair(soft, stiff, mixing(soft, stiff, library, file=where, key="given.mix"), library, where)
    middle = pair.material(pair.grade(0.5 * pair.law.wall_top))
    if printer.mode_for(middle) is None:
        raise InputError(
            f"given.mix = {shown(name)}{'' if named else ' (none was named)'}: the {printer.title} cannot mix {soft} "
            f"with {stiff} by fractions; {made_by(middle, library, '`profile`')}",
            file=where,
            fields=["given.mix"],
        )
    return pair


def mix_resins(pair: ResinPair, ambient_pressure: float) -> tuple[tuple[CandidateResin, ...], dict[str, str]]:
    """Mixes of a pair that the atlas covers, and by name the reason why each other is left out."""
    resins, out = [], {}
    for fraction in levels(pair.law):
        resin = pair.resin(round(float(fraction), 4))
        why = resin_outside_atlas(material_sensor(resin.material).wall, ambient_pressure)
        if why is None:
            resins.append(resin)
        else:
            out[resin.name] = why
    return tuple(resins), out


_SEARCHED: dict[str, str] = data_of(__file__)
"""Fields of a design that the search finds, and the options that fix them instead."""

_FINGER = "connector.finger_diameter_mm"

_WALL_SHARE = 0.15
"""Wall over radius in the drawing of a base if the given radius or wall does not suit the base's other."""


def setting_changes(target: Target, library: Library) -> Changes:
    """Changes of a target to its base design, by ``table.key``.

    Raises InputError for a field that the search finds."""
    setting = target.setting
    changes = parse_changes(setting.assignments)
    for key, value in changes.items():
        if key in _SEARCHED:
            raise InputError("the search finds it", key=key, value=value, remedy=f"settle it by {_SEARCHED[key]}")
    values = {
        "print.profile": setting.profile,
        "pneumatics.tube_length_mm": setting.tube_length_mm,
        "pneumatics.dead_volume_mL": setting.dead_volume_mL,
        "pneumatics.gauge": setting.gauge,
    }
    changes |= {key: value for key, value in values.items() if value is not None}
    finger_mm = target.target.finger_diameter_mm
    return changes if finger_mm is None else changes | _on_finger(finger_mm, target, changes, library)


def base_scene(target: Target, where: str, library: Library) -> ResolvedDesign:
    """Resolved design that gives everything the target does not; candidates replace its dome.

    Raises InputError if it names something unknown; ``where`` is the target's file, for messages.
    """
    with named_by_target(target, where):
        scene = _base_scene(target, where, library, _source(target, library))
        if target.setting.base is None:
            try:
                assemble(scene)
            except InputError:
                # A small dome has no space for the wider channel of that port.
                scene = _base_scene(target, where, library, DesignSource("default", {}, "the default design"))
        return scene


@contextmanager
def named_by_target(target: Target, where: str) -> Iterator[None]:
    """Context in which errors on the target's base or its finger name the target's key and its file ``where``."""
    try:
        yield
    except PneutouchError as error:
        for each in (error, *error.others):
            if each.key == _FINGER and target.target.fits is not None:
                each.file, each.key, each.value = where, "target.fits", target.target.fits
            elif each.file is None and each.key in ("setting.base", "target.fits"):
                each.file = where
        raise


def _base_scene(target: Target, where: str, library: Library, source: DesignSource) -> ResolvedDesign:
    given, chosen = target.given, setting_changes(target, library)
    sizes = {"membrane.inner_radius_mm": given.inner_radius_mm, "membrane.wall_thickness_mm": given.wall_thickness_mm}
    changes = {**chosen} | {key: size for key, size in sizes.items() if size is not None}
    membrane = source.changed(chosen).membrane
    if given.wall_thickness_mm is not None and given.inner_radius_mm is None:
        if given.wall_thickness_mm >= membrane.inner_radius_mm:
            changes["membrane.inner_radius_mm"] = given.wall_thickness_mm / _WALL_SHARE
    elif given.inner_radius_mm is not None and membrane.wall_thickness_mm >= given.inner_radius_mm:
        changes["membrane.wall_thickness_mm"] = _WALL_SHARE * given.inner_radius_mm
    try:
        changes["membrane.material"] = _some_resin(target, where, chosen, library)
        scene = load_scene(source, changes, library)
    except PneutouchError as error:
        if error.file is None and error.key not in chosen:
            error.file = where
        raise
    if target.setting.shapes is None:
        check_shape(scene)
    check_central(scene)
    return scene


def check_central(scene: ResolvedDesign) -> None:
    """Raise InputError for contact off the axis, which the search does not cover."""
    off_axis = scene.design.contact.off_axis
    if not off_axis:
        return
    key, value = next(iter(off_axis.items()))
    raise InputError(
        "the search is made with central and level contact",
        file=scene.where,
        key=f"contact.{key}",
        value=value,
        remedy="select without it, then `predict` the selected design with it",
    )


def requested_pair(target: Target, where: str, printer: Printer, library: Library) -> ResinPair | None:
    """Pair to mix: the one named, or the usual one for a grade; None if single resins are searched."""
    given = target.given
    if given.mix is None and not given.graded:
        return None
    return pair_of(given.mix or USUAL, printer, library, where, named=given.mix is not None)


def prints(scene: ResolvedDesign, material: Any) -> bool:
    """True if the membrane's printer runs a resin, together with the connector's if both are one piece."""
    with_it = (scene.connector_material,) if isinstance(scene.seat, OnePiece) else ()
    return scene.printer.mode_for(material, *with_it) is not None


def with_connector(scene: ResolvedDesign) -> str:
    """Addition to "cannot run it" for a resin that is printed in one piece with the connector; else empty."""
    return f" with {scene.connector_material.label}" if isinstance(scene.seat, OnePiece) else ""


def _source(target: Target, library: Library) -> DesignSource:
    """The base, else the default; without calibration and accepted warnings, which hold for its own membrane alone."""
    if target.setting.base is None:
        # As in a new design, whose port no rule finds fault with.
        port = {"connector": {"port": PRINTED_PORT}} if target.have.holds("ports", PRINTED_PORT) else {}
        return DesignSource("default", port, f"the default design{f', port {PRINTED_PORT}' if port else ''}")
    try:
        source = DesignSource.of(target.setting.base, library)
    except PneutouchError as error:
        error.key = "setting.base" if error.key == "design" else error.key
        raise
    return replace(
        source, content={key: value for key, value in source.content.items() if key not in (CALIBRATION, "accepted")}
    )


def settled_base(target: Target, changes: Changes, library: Library) -> DesignFile:
    """Base design with the changes, before its names are resolved."""
    return _source(target, library).changed(changes)


def _on_finger(finger_mm: float, target: Target, changes: Changes, library: Library) -> dict[str, str | float]:
    """Changes for a finger: its diameter, and the base's mount if a sleeve, else the one for the nearest finger."""
    sleeves = {
        name: mount for name in library.paths("mounts") if isinstance(mount := library.load("mounts", name), Sleeve)
    }
    chosen = settled_base(target, changes, library).connector.mount
    if chosen not in sleeves:
        if "connector.mount" in changes:
            problem = f"it goes over no finger; {', '.join(sleeves)} does"
            raise InputError(problem, key="connector.mount", value=chosen, remedy="take that, or leave `fits` out")
        if not sleeves:
            raise InputError("no mount goes over a finger", key="target.fits", value=f"finger:{finger_mm:g}")
        chosen = min(sleeves, key=lambda name: (abs(sleeves[name].finger_diameter - finger_mm), name))
    return {"connector.mount": chosen, _FINGER: finger_mm}


def _some_resin(target: Target, where: str, changes: Changes, library: Library) -> str:
    """A resin to draw the base with: the first allowed one that its printer runs. Raises InputError if none is."""
    profile = settled_base(target, changes, library).print.profile
    key = "setting.profile" if target.setting.profile is not None else "print.profile"
    printer: Printer = library.load("printers", profile, file=where, key=key)
    _check_shelf(target, profile, where, library)
    pair = requested_pair(target, where, printer, library)
    shelf = [name for name in sorted(library.paths("materials")) if target.have.holds("materials", name)]
    names = [pair.soft] if pair else target.given.materials or shelf
    loaded = {name: library.load("materials", name, file=where, key="given.materials") for name in names}
    for name in target.given.materials or []:
        if loaded[name].kind != "elastomer":
            raise InputError(
                f"{name} is {loaded[name].kind}", file=where, key="given.materials", remedy="it must be an elastomer"
            )
    runs = [name for name, m in loaded.items() if m.kind == "elastomer" and printer.mode_for(m) is not None]
    if not runs:
        limited = pair or target.given.materials or target.have.materials
        named = {name: m for name, m in loaded.items() if m.kind == "elastomer"} if limited else {}
        raise _runs_none(printer, named, where, library, target.have.printers)
    return runs[0]


def read_shelf(path: Path) -> Shelf:
    """Table [have] of a target, from a file with the keys of that table. Raises InputError for an unknown name."""
    content = read_given(path, 'give a file with lists such as materials = ["TangoPlus"] and printers')
    shelf = validate(Shelf, content, str(path))
    _check_known(shelf, Library.default(), str(path), "")
    return shelf


def _check_known(shelf: Shelf, library: Library, where: str, prefix: str) -> None:
    """Raise InputError for an unknown name on a shelf, or resins without an elastomer; keys begin with ``prefix``."""
    for kind in type(shelf).model_fields:
        parts = [library.load(kind, name, file=where, key=f"{prefix}{kind}") for name in getattr(shelf, kind) or ()]
        if kind == "materials" and parts and all(part.kind != "elastomer" for part in parts):
            raise InputError("none is an elastomer", file=where, key=f"{prefix}{kind}", remedy="add the dome's resin")


def _check_shelf(target: Target, profile: str, where: str, library: Library) -> None:
    """Raise InputError for an unknown name on the shelf, or if the membrane's printer ``profile`` is not on it."""
    _check_known(target.have, library, where, "have.")
    if not target.have.holds("printers", profile):
        raise InputError(
            f"the printer {profile} is not on the shelf, which has {', '.join(target.have.printers or ())}",
            file=where,
            remedy="give one of them by `profile`, or `process` any",
        )


def _runs_none(
    printer: Printer, named: dict[str, Material], where: str, library: Library, shelf: list[str] | None
) -> InputError:
    """Error for a printer that runs none of the materials ``named``, or no elastomer at all if none is named; its
    remedies take the printers of the ``shelf``, all if that is None."""
    for name, material in named.items():
        if casting_missing(printer, material):
            return uncast(printer, material, str(library.paths("materials")[name]))
    takes = [made_by(material, library, "`profile`", shelf) for material in named.values()]
    processes = dict.fromkeys(
        one.process for material in named.values() for one in makers(material, library, shelf).values()
    )
    if processes:
        takes.append(f"or give `processes` {' or '.join(processes)}")
    problem = f"the {printer.title} runs {'none of ' if named else ''}{', '.join(named) or 'no known elastomer'}"
    return InputError(problem, file=where, remedy="; ".join(takes) or "give another `profile`")


ANY = "any"
"""Name that stands for every gauge of the library."""
