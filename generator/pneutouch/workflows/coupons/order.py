"""Order of coupons: which are printed, on which machine and in which material; and the results file to fill in."""

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from pneutouch.body import Solid
from pneutouch.catalogue import Library, ResolvedDesign, load_scene
from pneutouch.catalogue.mixture import mixed_material, mixing
from pneutouch.catalogue.printers import cannot_run
from pneutouch.errors import InputError, nearest
from pneutouch.parts.coupons import COUPONS, Coupon, CouponContext, Nominal
from pneutouch.parts.mould.size import open_mould
from pneutouch.report.pages import filled
from pneutouch.spec.coupon import CouponResults
from pneutouch.spec.design import Mould, Print
from pneutouch.spec.fields import table_of
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.membrane_table import Membrane
from pneutouch.spec.printer import Printer
from pneutouch.spec.toml_text import key_text, value_text
from pneutouch.wording import counted

FRACTIONS = (0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.27, 0.35)
"""Volume fractions of the stiff resin in printed mixes: our own choice for TangoPlus with VeroClear, whose curve ends
at 35.6 %. By each curve of that pair the modulus rises less than 2.5-fold from one fraction to the next, as far as the
curve is known (docs/background/mixing.md)."""


@dataclass(frozen=True, slots=True)
class CouponMix:
    """Mix of a pair of resins ``SOFT+STIFF`` at one volume fraction of the stiff one."""

    pair: str
    fraction: float
    material: Material

    @property
    def about(self) -> str:
        """Name of the mix's coupons: ``TangoPlus+VeroClear-15``."""
        return f"{self.pair}-{100 * self.fraction:g}"


def resins_of(pair: str, *, file: str | None = None, key: str) -> tuple[str, str]:
    """Soft and stiff resin of a text ``SOFT+STIFF``. Raises InputError for any other text."""
    names = [name.strip() for name in pair.split("+")]
    if len(names) != 2 or not all(names) or names[0] == names[1]:
        raise InputError("write two resins, SOFT+STIFF, such as TangoPlus+VeroClear", file=file, key=key, value=pair)
    return names[0], names[1]


def blends(pair: str, library: Library) -> list[CouponMix]:
    """Mixes of a pair to print, up to the end of its mixing curve or to the stiffest that a membrane may have.

    Raises InputError for unknown resins or a pair without a curve."""
    soft, stiff = resins_of(pair, key="mixing")
    for name in (soft, stiff):
        library.load("materials", name, key="mixing")
    top = mixing(soft, stiff, library, key="mixing").wall_top
    grades = [
        Grade.model_validate({"from": soft, "to": stiff, "fraction": fraction})
        for fraction in FRACTIONS
        if fraction <= top
    ]
    pair = f"{soft}+{stiff}"
    return [CouponMix(pair, g.fractions[0], mixed_material(g, library, file=None, key="mixing")) for g in grades]


MOST_COPIES = 100

CAST_EXCESS = 1.3
"""Ratio of silicone mixed to silicone in the coupons: some is struck off, some stays in the cup; our choice."""

MIXED = ("puck", "dumbbell")
"""Names of the coupons that are printed of mixes."""

MIXED_COPIES = 2
"""Copies of each fraction: the least that gives a spread, two pucks making the 6 mm under the durometer."""


@dataclass(frozen=True)
class CouponOptions:
    """Options of the user; one that is None or empty is left to the program."""

    profile: str | None = None
    materials: Sequence[str] = ()
    design: str | None = None
    only: Sequence[str] = ()
    copies: Mapping[str, int] = field(default_factory=dict)
    mixing: Sequence[str] = ()


@dataclass(frozen=True)
class CouponItem:
    """One coupon to print: ``about`` is the material or design under which the results file lists it.

    ``blend`` is given for a coupon of a mix, which is listed by pair and fraction. ``mould`` is the mould's material
    for a cast coupon, whose ``printer`` prints the mould; else None."""

    coupon: Coupon
    about: str
    printer_name: str
    printer: Printer
    context: CouponContext
    copies: int
    blend: CouponMix | None = None
    mould: Material | None = None

    @property
    def material(self) -> Material:
        """Material of the coupon."""
        return self.context.material

    @property
    def printed(self) -> Material:
        """Material that is printed: the coupon's, or the mould's if the coupon is cast."""
        return self.mould or self.material

    def solids(self) -> tuple[Solid, ...]:
        """Solids to print: the coupon, or the open mould in which it is cast."""
        drawn, casting = self.coupon.draw(self.context), self.material.casting
        if self.mould is None or casting is None:
            return drawn
        factor = 1.0 / (1.0 - 0.01 * casting.shrinkage_percent.nominal)
        return tuple(open_mould(solid, self.mould, factor) for solid in drawn)

    @property
    def silicone_g(self) -> float:
        """Mass of silicone to mix for the copies of a cast coupon."""
        return CAST_EXCESS * self.copies * sum(solid.mass for solid in self.coupon.draw(self.context))

    @property
    def nominals(self) -> tuple[Nominal, ...]:
        """Quantities to measure on the coupon; only the hardness of a mixed puck, as a mixing curve has no density."""
        listed = self.coupon.nominals(self.context)
        return listed if self.blend is None or self.coupon.name != MIXED[0] else listed[:1]


@dataclass(frozen=True)
class CouponOrder:
    """Everything to print. ``name`` is that of the output folder, ``profile`` the printer named or the default one."""

    name: str
    profile: str
    scene: ResolvedDesign | None
    items: tuple[CouponItem, ...]

    def machines(self) -> dict[str, tuple[CouponItem, ...]]:
        """Items by printer name, ``profile`` first."""
        names = dict.fromkeys((self.profile, *(item.printer_name for item in self.items)))
        groups = {name: tuple(item for item in self.items if item.printer_name == name) for name in names}
        return {name: items for name, items in groups.items() if items}


def order(options: CouponOptions, library: Library | None = None) -> CouponOrder:
    """The order that the options ask for. Raises InputError for unknown or contradictory names, or a wrong machine."""
    library = library or Library.default()
    scene = None if options.design is None else load_scene(options.design, None, library)
    profile = options.profile or (Print().profile if scene is None else scene.design.print.profile)
    printer: Printer = library.load("printers", profile, key="profile")
    families = _families(options)
    items: list[CouponItem] = []
    for name in _materials(options, scene, printer, profile, library):
        material: Material = library.load("materials", name, key="material")
        if printer.mode_for(material) is None:
            raise cannot_run(printer, name, material, library, "`profile`", key="material", value=name)
        if printer.is_casting:
            items += _cast(options, name, CouponContext(material, scene), families, library)
            continue
        items += [
            CouponItem(coupon, name, profile, printer, CouponContext(material, scene), _copies(options, coupon))
            for coupon in families
            if coupon.belongs != "design" and material.kind in coupon.kinds
        ]
    items += _of_mixing(options, profile, printer, families, library)
    if scene is not None:
        items += _of_design(options, scene, profile, families)
    _check_any(options, families, items)
    pairs = dict.fromkeys(item.blend.pair for item in items if item.blend is not None)
    names = ["coupons", profile, *([scene.name] if scene else []), *pairs]
    return CouponOrder("-".join(names), profile, scene, tuple(items))


def _cast(
    options: CouponOptions, about: str, context: CouponContext, families: list[Coupon], library: Library
) -> list[CouponItem]:
    """Moulds of the coupons of a material that is cast, on the printer that the design names for moulds."""
    chosen = Mould() if context.scene is None else context.scene.design.mould
    printer: Printer = library.load("printers", chosen.profile, key="mould.profile")
    mould: Material = library.load("materials", chosen.material, key="mould.material")
    return [
        CouponItem(coupon, about, chosen.profile, printer, context, _copies(options, coupon), mould=mould)
        for coupon in families
        if coupon.belongs == "material" and context.material.kind in coupon.kinds
    ]


def _families(options: CouponOptions) -> list[Coupon]:
    for word in (*options.only, *options.copies):
        if word not in COUPONS:
            key = "only" if word in options.only else "copies"
            raise InputError(f"no such coupon.{nearest(word, COUPONS)}", key=key, value=word)
    for word, count in options.copies.items():
        if not 1 <= count <= MOST_COPIES:
            raise InputError(f"must be from 1 to {MOST_COPIES}", key="copies", value=f"{word}={count}")
    chosen = [COUPONS[name] for name in COUPONS if not options.only or name in options.only]
    needs = [coupon.name for coupon in chosen if coupon.belongs == "design"]
    if options.only and needs and options.design is None:
        raise InputError(
            f"the {COUPONS[needs[0]].title} belongs to a design", key="only", value=needs[0], remedy="give `design`"
        )
    return [coupon for coupon in chosen if coupon.belongs != "design" or options.design is not None]


def _materials(
    options: CouponOptions, scene: ResolvedDesign | None, printer: Printer, profile: str, library: Library
) -> list[str]:
    """Names of the materials: those the user named (none with mixes alone); else the design's membrane if its printer
    is the one; else the default resin if the printer runs it, else the first that it runs."""
    if options.materials or options.mixing:
        return list(dict.fromkeys(options.materials))
    if scene is not None and scene.design.print.profile == profile:
        chosen = scene.design.membrane.material
        return [chosen] if isinstance(chosen, str) else [chosen.from_]
    runs = [name for name, one in library.all("materials", Material).items() if printer.mode_for(one) is not None]
    if not runs:
        raise InputError(
            f"no known material runs on the {printer.title}", key="profile", value=profile, remedy="give `material`"
        )
    usual = Membrane().material
    return [usual if usual in runs else runs[0]]


def _of_mixing(
    options: CouponOptions, profile: str, printer: Printer, families: list[Coupon], library: Library
) -> list[CouponItem]:
    """Coupons of mixes: every fraction of each pair; pucks, and dumbbells only if asked for (they take a large
    tray)."""
    chosen = [
        coupon
        for coupon in families
        if coupon.name in MIXED and (coupon.name in options.only or (not options.only and coupon.name == MIXED[0]))
    ]
    items = []
    for pair in dict.fromkeys(options.mixing):
        for blend in blends(pair, library):
            if printer.mode_for(blend.material) is None:
                raise cannot_run(printer, None, blend.material, library, "`profile`", key="mixing", value=pair)
            items += [
                CouponItem(
                    coupon,
                    blend.about,
                    profile,
                    printer,
                    CouponContext(blend.material),
                    options.copies.get(coupon.name, MIXED_COPIES),
                    blend,
                )
                for coupon in chosen
            ]
    return items


def _of_design(options: CouponOptions, scene: ResolvedDesign, profile: str, families: list[Coupon]) -> list[CouponItem]:
    """Cap and plug of the design, and the gauge of the connector's machine if that is not ``profile``."""
    machine, printer = scene.design.print.connector_profile, scene.connector_printer
    context, material = CouponContext(scene.connector_material, scene), scene.design.connector.material
    items = []
    for coupon in families:
        if coupon.belongs == "design":
            items.append(CouponItem(coupon, scene.name, machine, printer, context, _copies(options, coupon)))
        elif coupon.belongs == "printer" and machine != profile:
            items.append(CouponItem(coupon, material, machine, printer, context, _copies(options, coupon)))
    return items


def _copies(options: CouponOptions, coupon: Coupon) -> int:
    return options.copies.get(coupon.name, coupon.copies)


def _check_any(options: CouponOptions, families: list[Coupon], items: list[CouponItem]) -> None:
    made = {item.coupon.name for item in items}
    for coupon in families:
        if options.only and coupon.name not in made:
            raise InputError(
                f"the {coupon.title} is for {' or '.join(coupon.kinds)}",
                key="only",
                value=coupon.name,
                remedy="give another `material`",
            )
    if not items:
        raise InputError("nothing to print", remedy="give another `only`")


def results_template(order: CouponOrder) -> str:
    """Results file to fill in: TOML that is valid as soon as lab and date are given."""
    tables: list[tuple[Any, ...]] = []
    filed: set[tuple[str, float]] = set()
    for item in order.items:
        name, blend, fraction = item.coupon.name, item.blend, None
        if blend is None:
            steps = [name, *([item.printer_name] if item.coupon.belongs == "printer" else []), item.about]
            path = ".".join(map(key_text, steps))
        else:
            # Hardness stands in the fraction's table, which its first coupon begins; dumbbells in one below.
            path = "" if name == MIXED[0] else f"mixing.{key_text(blend.pair)}.{name}"
            fraction = None if (blend.pair, blend.fraction) in filed else blend.fraction
            filed.add((blend.pair, blend.fraction))
        model = _model(name)
        tables.append((item, path, fraction, _settings(model), _settings(table_of(model, item.coupon.each))))
    return filled("results.toml.j2", tables=tables, key=key_text, value=value_text, counted=counted)


def _settings(model: type[BaseModel] | None) -> dict[str, tuple[float, list[str]]]:
    """The numbers that state how a coupon was measured: their defaults, and their help on lines."""
    return {
        key: (info.default, textwrap.wrap(info.description or "", 96))
        for key, info in ({} if model is None else model.model_fields).items()
        if isinstance(info.default, float)
    }


def _model(coupon: str) -> type[BaseModel]:
    """Model of one table of a coupon in the results file."""
    field = next(name for name, info in CouponResults.model_fields.items() if coupon in (name, info.alias))
    kind: Any = CouponResults.model_fields[field].annotation
    while not (isinstance(kind, type) and issubclass(kind, BaseModel)):
        kind = kind.__args__[-1]
    return kind
