"""A design as an object: keyword arguments in, predictions, findings and print files out."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch.api import show
from pneutouch.api.fields import WHERE, changes, keywords, named_by_keyword, number_of, plain
from pneutouch.api.prediction import Prediction, axes_of
from pneutouch.api.results import CheckResult, DrivingResult, tasks_of
from pneutouch.body import Body
from pneutouch.catalogue import DesignSource, Library, load_scene, user_folder
from pneutouch.catalogue.scene import check_kind, membrane_material_of
from pneutouch.errors import InputError, shown
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.subject import by_mixing_curve
from pneutouch.mechanics.models.choice import model_options
from pneutouch.output.new import write_design
from pneutouch.parts import Assembly, assemble
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import declaration, table_of
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import override
from pneutouch.spec.toml_text import design_template
from pneutouch.spec.values import plain_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _scaled(ax: Axes) -> Axes:
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.set(xlabel="x (mm)", ylabel="z (mm)")
    return ax


def pressures_changed(driving_pressures_kPa: float | Iterable[float] | None) -> dict[str, Any]:
    """The change that gives a design other driving pressures, kPa; None changes nothing."""
    values_kPa = plain(driving_pressures_kPa)
    return {} if values_kPa is None else {"pneumatics.driving_pressures_kPa": values_kPa}


class Design(show.Shown):
    """A sensor's design. It does not change: `replace` gives another one.

    Keyword arguments are the fields of a design file, with their units in their names; what is left out has its
    default, and ``profile`` the default printer, or if that does not run the resin the first that does. A table may be
    given whole: ``pneumatics={"tube_length_mm": 80}``. Raises InputError naming the keyword.
    """

    def __init__(self, name: str = "design", **fields: Any) -> None:
        self._take(name, {}, fields)

    def _take(self, name: Any, content: Any, fields: dict[str, Any]) -> None:
        if not isinstance(name, str):
            remedy = "give a text; fields have keywords, such as inner_radius_mm=6"
            raise InputError("must be a text", key="name", value=name, remedy=remedy)
        plain_name(name, key="name")
        with named_by_keyword():
            whole = override(content, changes(DesignFile, fields), DesignFile)
            self.file = DesignSource(name, whole, WHERE).changed({})
            if "profile" not in whole.get("print", {}):
                whole["print"] = {**whole.get("print", {}), "profile": _printer(self.file)}
            self.source = DesignSource(name, whole, WHERE)
            self.file = self.source.changed({})
            if "material" in fields:
                resin = membrane_material_of(self.file, WHERE, Library.default())
                check_kind(WHERE, "membrane.material", resin, "elastomer")
            for field in (keywords(DesignFile).get(one, "") for one in fields if one != "material"):
                table, _, key = field.partition(".")
                model = table_of(DesignFile, table) if key else None
                kind, chosen = (
                    (declaration(model, key).registry, attrgetter(field)(self.file)) if model else (None, None)
                )
                if kind and chosen is not None:
                    Library.default().load(kind, chosen, file=WHERE, key=field)

    @classmethod
    def of(cls, source: DesignSource) -> Design:
        """The design of a source, such as a file that was read. Raises InputError naming file, key and value."""
        design = cls.__new__(cls)
        design.source, design.file = source, source.changed({})
        return design

    @property
    def name(self) -> str:
        """Name of the design, and of its output folder."""
        return self.source.name

    def __getattr__(self, keyword: str) -> Any:
        """The value of a field, by the keyword that sets it."""
        field = None if keyword.startswith("_") else keywords(DesignFile).get(keyword)
        if field is None:
            raise AttributeError(f"a design has no {keyword!r}; it has {', '.join(keywords(DesignFile))}")
        return attrgetter(field)(self.file)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in keywords(DesignFile):
            raise AttributeError(f"a design does not change; use design.replace({name}=...)")
        super().__setattr__(name, value)

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *keywords(DesignFile)]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Design) and (self.name, self.file) == (other.name, other.file)

    __hash__ = None  # type: ignore[assignment]

    def replace(self, name: str | None = None, **fields: Any) -> Design:
        """A copy with fields changed and, if given, another name, which a title that is the old name becomes too."""
        if name and self.file.document.title == self.name:
            fields = {"title": name, **fields}
        design = type(self).__new__(type(self))
        design._take(self.name if name is None or name == "" else name, self.source.content, fields)
        return design

    def save(self, name_or_path: str | Path | None = None, *, overwrite: bool = False) -> Path:
        """Write the design file and return its path; a bare name goes to the user's ``designs/``.

        A title that is the design's name becomes the name of the file. An existing file is replaced only with
        ``overwrite``.
        """
        path = Path(name_or_path or self.name)
        folder = path.parent if path.suffix == ".toml" or len(path.parts) > 1 else user_folder() / "designs"
        name, content = path.name.removesuffix(".toml"), self.file.model_dump(by_alias=True)
        if content["document"]["title"] == self.name:
            content["document"]["title"] = name
        text = design_template(name, content, "Every key may be left out.")
        return write_design(name, folder, text, overwrite=overwrite)

    def predict(
        self,
        driving_pressures_kPa: float | Iterable[float] | None = None,
        *,
        model: str | None = None,
        tolerance: float | str | None = None,
        closure: str = "variational",
        clamp: str = "base",
        aged: bool = False,
        contact_anywhere: bool = False,
    ) -> Prediction:
        """Predict the figures at driving pressures in kPa, or at one (None: the design's).

        ``model`` is "membrane", "atlas", "solid", "harmonic" or "auto": the cheapest whose error meets ``tolerance``, a
        share or a text such as "2%". None: the solid, and harmonic for contact off the axis; with a tolerance, auto.
        ``contact_anywhere`` counts an unknown object and place of contact in the interval, as in a design. See
        `evaluation.evaluate` for the rest. Raises InputError if the design cannot work.
        """
        changed, options = pressures_changed(driving_pressures_kPa), model_options(model, tolerance)
        if contact_anywhere:
            changed["contact.anywhere"] = True
        with named_by_keyword():
            return Prediction(evaluate(self.source, changed, closure=closure, clamp=clamp, aged=aged, **options))

    def driving_pressure(
        self,
        *,
        sensitivity_kPa_per_N: float | None = None,
        stiffness_N_per_mm: float | None = None,
        force_range_N: float | None = None,
        leak: str | Path | None = None,
        model: str | None = None,
        tolerance: float | str | None = None,
    ) -> DrivingResult:
        """The driving pressure that gives one figure; see `driving_schedule`. Raises InputError."""
        figures = {
            "sensitivity_kPa_per_N": sensitivity_kPa_per_N,
            "stiffness_N_per_mm": stiffness_N_per_mm,
            "force_range_N": force_range_N,
        }
        task = {key: value for key, value in figures.items() if value is not None}
        return self.driving_schedule([task], leak=leak, model=model, tolerance=tolerance)

    def driving_schedule(
        self,
        tasks: str | Path | Iterable[Mapping[str, Any]],
        *,
        leak: str | Path | None = None,
        model: str | None = None,
        tolerance: float | str | None = None,
    ) -> DrivingResult:
        """Driving pressures for tasks in order: a file, or mappings of a figure to a value (and ``name``).

        ``leak`` is a results file of coupons or what `characterize` wrote. Without ``model`` the cheapest model that
        meets ``tolerance`` is used. Raises InputError.
        """
        from pneutouch.workflows.driving import driving_record, driving_schedule, read_leak

        with named_by_keyword():
            required = tasks_of(tasks)
            measured = None if leak is None else read_leak(Path(leak), self.name)
            options = model_options(model or "auto", tolerance)
            return DrivingResult(driving_record(driving_schedule(self.source, required, leak=measured, **options)))

    def check(self, *, deep: bool = False) -> CheckResult:
        """Check printability and mechanical limits; ``deep`` has pymeshlab inspect the meshes as well."""
        evaluation = self._evaluated
        more = evaluation.deep_findings() if deep else []
        return CheckResult(self.name, (*evaluation.findings, *more), by_mixing_curve(evaluation.curves))

    def build(self, out: str | Path = "outputs") -> Path:
        """Write print files, prediction and datasheet into ``out/<name>/``; returns that folder.

        Raises RuleBrokenError, with nothing written, where a rule is broken.
        """
        from pneutouch.workflows.build import build

        with named_by_keyword():
            return build(self._evaluated, Path(out))

    def export_reader(
        self,
        out: str | Path = "outputs",
        *,
        model: str | None = None,
        tolerance: float | str | None = None,
        age_years: float | None = None,
    ) -> Path:
        """Write the pressure-to-force model in C, Python and JSON into ``out/<name>-reader/``; returns that folder.

        ``model`` as for `predict`, but None is "auto". ``age_years`` is the time since the calibration, or since the
        print, that the uncertainty counts; None: none since a calibration, else a year.
        """
        from pneutouch.workflows.export_reader import make_reader, write_reader

        options = model_options(model or (None if tolerance else "auto"), tolerance)
        with named_by_keyword():
            aged = number_of(age_years, "age_years")
            return write_reader(make_reader(evaluate(self.source, **options), aged), Path(out))

    @cached_property
    def _evaluated(self) -> Evaluation:
        with named_by_keyword():
            return evaluate(self.source)

    @cached_property
    def assembly(self) -> Assembly:
        """The bodies as exact solids, in the place where they are glued."""
        with named_by_keyword():
            return assemble(load_scene(self.source))

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The print meshes of the sensor's bodies, lengths in mm."""
        return tuple(self.assembly.bodies)

    def plot_section(self, ax: Axes | None = None) -> Axes:
        """Draw the hatched section of all bodies through the axis, lengths in mm; returns the axes."""
        from pneutouch.report.section import draw_section

        ax = axes_of(ax)
        draw_section(ax, self.assembly)
        return _scaled(ax)

    def plot_mould(self, ax: Axes | None = None, *, labels: bool = True) -> Axes:
        """Draw one cavity of the closed mould in section, turned over as it is poured, lengths in mm; returns the axes.

        Raises InputError for a membrane that is printed.
        """
        from pneutouch.report.mould import draw_mould

        if self.assembly.mould is None:
            raise InputError(
                "the membrane is printed, not cast: it has no mould",
                key="profile",
                value=self.assembly.scene.design.print.profile,
                remedy='give a printer of moulds, such as profile="silicone-casting"',
            )
        ax = axes_of(ax)
        draw_mould(ax, self.assembly.mould, labels)
        return _scaled(ax)

    def to_dict(self) -> dict[str, Any]:
        """The tables of the design file, every field with its value."""
        return self.file.model_dump(mode="json", by_alias=True)

    def _head(self) -> str:
        return f"Design {shown(self.name)}"

    def _rows(self) -> list[Any]:
        return show.table_rows(self.file)

    def _cells(self) -> list[Any]:
        return show.field_rows(self.file)

    def _picture(self) -> Assembly:
        return self.assembly


def load(name_or_path: str | Path) -> Design:
    """A design by its name (the user's ``designs/`` first, then the shipped ones) or by its path."""
    return Design.of(DesignSource.of(str(name_or_path), Library.default()))


def _printer(file: DesignFile) -> str:
    """Name of the default printer if it runs the resin, else of the first that does."""
    library, usual = Library.default(), file.print.profile
    material = library.all("materials", Material).get(str(file.membrane.material))
    printers = library.all("printers", Printer)
    names = sorted(printers, key=lambda name: name != usual)
    return next((name for name in names if material and printers[name].mode_for(material)), usual)


def source_of(design: Design | str | Path) -> str | DesignSource:
    """A design in the form that workflows take: its source, or the name or path as text."""
    return design.source if isinstance(design, Design) else str(design)


Design.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
    [
        inspect.Parameter("name", inspect.Parameter.POSITIONAL_OR_KEYWORD, default="design"),
        *(inspect.Parameter(k, inspect.Parameter.KEYWORD_ONLY, default=...) for k in keywords(DesignFile)),
    ]
)
