"""Jobs of the page on one design: to open a file that the user gave, to build it, and to map it over two fields."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import CachedLibrary, is_specimen
from pneutouch.errors import InputError, PneutouchError, one_line
from pneutouch.evaluation.evaluate import PredictionOptions, evaluate
from pneutouch.formats import KEY, check_format
from pneutouch.mechanics.models.choice import model_options
from pneutouch.output.files import MANIFEST
from pneutouch.output.recipe import scene_kinds
from pneutouch.results.record import plain
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import declarations, table_of
from pneutouch.spec.files import read_bytes
from pneutouch.spec.read import read_toml, toml_value
from pneutouch.spec.tray import spread
from pneutouch.spec.values import is_finite, name_of, plain_name
from pneutouch.stopping import temporary_folder
from pneutouch.studio.candidate import state_of
from pneutouch.studio.form import PAGE, Question
from pneutouch.studio.job import Report
from pneutouch.wording import rounded
from pneutouch.workflows.build import STEPS, build, calibrated_name, described
from pneutouch.workflows.sweep.grid import PRESSURES, Settings, SweepPlan
from pneutouch.workflows.sweep.variables import ENDS, INTERVAL, MAPPED, reason_words
from pneutouch.workflows.sweep.work import chunks, compute, study, unpack


def nearest_state(source: DesignSource, bases: Mapping[str, str], library: Library) -> Question:
    """Page state whose design equals that of ``source`` in every field.

    Its base is the one with the design's name, else the one from which the design differs in the fewest fields. Raises
    InputError if the design is wrong, or if no page state gives exactly this design.
    """
    design = source.changed({})
    states: list[Question] = []
    for base in bases:
        try:
            states.append(state_of(design, base, bases, library))
        except PneutouchError:
            # A base whose file cannot be read is none to start from.
            continue
    if not states:
        raise InputError("no design of this page can be read", remedy="mend the design files that pneutouch list names")
    # By the same limits as what comes from a browser.
    nearest = min(states, key=lambda state: (state.base != source.name, len(state.values)))
    question = Question.of(plain(nearest))
    if question.source(bases, library).changed({}).model_dump() != design.model_dump():
        remedy = "build it by its file with the commands"
        raise InputError("has values that the page cannot hold", file=source.where, remedy=remedy)
    return question


_MOST_EXPORTED = 64 * 1024
_EXPORT_KEYS = {KEY, "version", "base", "values"}

_ENDINGS = "a 3MF that pneutouch build wrote, a design file (.toml), or an exported design (.json)"

Bases = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class OpenedDesign:
    """A design that was opened: its name, the state of the page that shows it, and notes for the user."""

    name: str
    question: Question
    notes: list[str]


def open_file(arguments: Mapping[str, Any], folder: Path, report: Report) -> OpenedDesign:
    """Read the only file of ``files``; return its design as a page state, with notes on parts that the page lacks.

    Raises InputError that names file, key and value.
    """
    if len(arguments["files"]) != 1:
        raise InputError("one file is opened at a time", remedy="give one file")
    path = Path(arguments["files"][0]["path"])
    try:
        return _opened(path, arguments["bases"], Library.default())
    except PneutouchError as error:
        raise _by_name(error, path) from None


def _opened(path: Path, bases: Bases, library: Library) -> OpenedDesign:
    readers = {".3mf": _from_3mf, ".toml": _from_toml, ".json": _from_export}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise InputError("the page opens no file of this kind", file=path, remedy=f"give {_ENDINGS}")
    return reader(path, bases, library)


def _from_toml(path: Path, bases: Bases, library: Library) -> OpenedDesign:
    content = read_toml(path)
    if is_specimen(content):
        remedy = "give the design of a sensor; pneutouch build takes a specimen"
        raise InputError("a texture specimen, which has no curves to show", file=path, remedy=remedy)
    source = DesignSource(name_of(path), content, str(path))
    load_scene(source, {}, library)
    return OpenedDesign(source.name, nearest_state(source, bases, library), [])


def _from_3mf(path: Path, bases: Bases, library: Library) -> OpenedDesign:
    # What reads meshes loads for a 3MF alone.
    from pneutouch.export.threemf_read import read_threemf
    from pneutouch.output.recipe import other_versions, read_recipe

    package = read_threemf(path)
    recipe = read_recipe(package)
    scene = recipe.scene
    source = DesignSource(scene.name, scene.design.model_dump(by_alias=True), str(path))
    notes = [f"made with {each}" for each in other_versions(package, recipe)]
    notes += _other_parts(scene, load_scene(source, {}, library))
    notes += _other_options(recipe.options)
    if notes:
        notes.append(f"pneutouch build {path.name} builds it as it was")
    return OpenedDesign(scene.name, nearest_state(source, bases, library), notes)


def _from_export(path: Path, bases: Bases, library: Library) -> OpenedDesign:
    content = _json(path)
    if KEY not in content:
        remedy = "give a file that Export wrote on this page"
        raise InputError("not a design that was exported here", file=path, remedy=remedy)
    check_format("exported-design", content, path)
    if set(content) != _EXPORT_KEYS or not isinstance(content["version"], str):
        raise InputError(f"an exported design has the keys {', '.join(sorted(_EXPORT_KEYS))}", file=path)
    question = Question.of({"base": content["base"], "values": content["values"]})
    source = question.source(bases, library)
    load_scene(source, {}, library)
    version = one_line(content["version"])
    notes = [] if version == __version__ else [f"exported by pneutouch {version} (here {__version__})"]
    return OpenedDesign(source.name, question, notes)


def _json(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(read_bytes(path, _MOST_EXPORTED, "exported design"))
    except (ValueError, RecursionError):
        raise InputError("not JSON", file=path, remedy=f"give {_ENDINGS}") from None
    if not isinstance(content, dict):
        raise InputError("not an exported design", file=path, remedy=f"give {_ENDINGS}")
    return content


def _other_parts(scene: ResolvedDesign, here: ResolvedDesign) -> list[str]:
    """Notes on parts of a recipe whose name stands for a different part here."""
    parts = [key for key in scene_kinds() if key != "design" and _data(scene, key) != _data(here, key)]
    return [f"its {key.replace('_', ' ')} is not the one of this name here, which the page takes" for key in parts]


def _data(scene: ResolvedDesign, key: str) -> Any:
    part = getattr(scene, key)
    return None if part is None else part.model_dump(mode="json")


def _other_options(options: PredictionOptions) -> list[str]:
    """Note on options of a prediction that the page does not have; empty without such options."""
    usual = PredictionOptions()
    given = {key: getattr(options, key) for key in ("closure", "clamp")}
    other = [f"{key} {value}" for key, value in given.items() if value != getattr(usual, key)]
    if options.model not in ("solid", "harmonic"):
        other.insert(0, f"model {options.model}")
    return [f"it was predicted with {', '.join(other)}, the page predicts without"] if other else []


def _by_name(error: PneutouchError, path: Path) -> InputError:
    """The error, and the further ones it holds, as InputError that shows the file's name without its folder."""
    place = f"{path.parent}/"
    first, *others = [InputError(_words(each).replace(place, "")) for each in (error, *error.others)]
    first.others = tuple(others)
    return first


def _words(error: PneutouchError) -> str:
    """Message of one error, without the messages of its ``others``."""
    alone = InputError(error.problem, file=error.file, key=error.key, value=error.value, remedy=error.remedy)
    return alone.message()


STAGES = ("prediction", *STEPS)
"""The stages that a build reports, in order."""

SHEET = "datasheet.html"


@dataclass(frozen=True, slots=True)
class BuiltFiles:
    """Files of a kind, and the kind in words."""

    files: list[str]
    words: str


@dataclass(frozen=True, slots=True)
class BuiltDesign:
    """A design that was built: its files, the path of its datasheet, files left out and why, and findings."""

    name: str
    question: Question
    groups: list[BuiltFiles]
    left_out: Mapping[str, Any]
    sheet: str
    findings: list[Mapping[str, Any]]


def build_design(arguments: Mapping[str, Any], folder: Path, report: Report) -> BuiltDesign:
    """Build the design of ``question`` into ``folder``. Raises InputError at the field, and RuleBrokenError."""
    question, library = Question.of(arguments.get("question")), Library.default()
    source = question.source(arguments["bases"], library)
    name = arguments.get("name") or calibrated_name(source, {})
    if name is not None:
        if not isinstance(name, str):
            raise InputError("must be a text", key="name", value=name)
        source = replace(source, name=plain_name(name, key="name"))
    report(0, len(STAGES), STAGES[0])
    evaluation = evaluate(source, **model_options(None, None), library=library)
    made = build(evaluation, folder, lambda step: report(STAGES.index(step), len(STAGES), step))
    files = sorted(path.relative_to(made).as_posix() for path in made.rglob("*") if path.is_file())
    groups = described(files, made.name)
    return BuiltDesign(
        name=source.name,
        question=question,
        groups=[BuiltFiles([f"{made.name}/{each}" for each in names], words) for names, words in groups],
        left_out=json.loads((made / MANIFEST).read_text(encoding="utf-8")).get("left_out", {}),
        sheet=f"{made.name}/{SHEET}",
        findings=[plain(finding.stated) for finding in evaluation.findings],
    )


GRID = 60
"""Number of values of each field of a map."""

_MAP_DIGITS = 6


@dataclass(frozen=True, slots=True)
class MapAxis:
    """A field of a map, ``table.key``, and its ascending values."""

    field: str
    values: list[float]

    @classmethod
    def of(cls, letter: str, given: Mapping[str, str | None]) -> "MapAxis":
        """The axis x or y of a request. Raises InputError at its field, ``low`` or ``high``."""
        field = given.get(f"{letter}.field") or ""
        low, high = (_within(field, f"{letter}.{end}", given) for end in ("low", "high"))
        if not low < high:
            raise InputError(f"must be above {low:g}, where the range begins", key=f"{letter}.high", value=high)
        return cls(field, spread(PAGE, field, low, high, GRID))


def _within(field: str, name: str, given: Mapping[str, str | None]) -> float:
    """The number ``name`` of a request. Raises InputError if it is none that ``field`` of a design can have."""
    table, _, key = field.partition(".")
    model = table_of(DesignFile, table)
    known = next((each for each in declarations(model) if each.key == key), None) if model else None
    if known is None or known.low is None or known.high is None:
        raise InputError("no field of numbers of a design", key=f"{name[0]}.field", value=field)
    value = toml_value(given.get(name) or "")
    if not is_finite(value) or not known.low <= value <= known.high:
        raise InputError(f"must be {known.right}", key=name, value=value)
    return float(value)


@dataclass(frozen=True, slots=True)
class DesignMap:
    """The figures that sweeps map, by name, with their labels: (x, y) each, None where one is missing;
    ``reasons`` (x, y): why, in words, "" if that is not known."""

    x: MapAxis
    y: MapAxis
    labels: Mapping[str, str]
    figures: Mapping[str, list[list[float | None]]]
    reasons: list[list[str]]


def map_design(arguments: Mapping[str, Any], folder: Path, report: Report) -> DesignMap:
    """Predict the design of ``question`` over two of its fields, as a sweep by the atlas does.

    ``values`` holds the texts of ``x.field``, ``x.low``, ``x.high``, the same of y, and ``map.pressure_kPa``.
    Raises InputError at these names.
    """
    question, library = Question.of(arguments.get("question")), CachedLibrary(Library.default().folders)
    given = Question.of({"base": question.base, "values": arguments.get("values")}).values
    x, y = MapAxis.of("x", given), MapAxis.of("y", given)
    if x.field == y.field:
        raise InputError("both axes have this field", key="y.field", value=y.field, remedy="choose another one here")
    source, at_kPa = question.source(arguments["bases"], library), _within(PRESSURES, "map.pressure_kPa", given)
    if at_kPa < 0.0:
        raise InputError("must be at least 0: the atlas has no vacuum", key="map.pressure_kPa", value=at_kPa)
    points: list[Settings] = [{PRESSURES: at_kPa, x.field: a, y.field: b} for a in x.values for b in y.values]
    for point in points:
        point[PRESSURES] = [point[PRESSURES]]
    plan = SweepPlan("map", PAGE, source, {}, points=tuple(points), model="atlas")
    resolved, known = study(plan, library, tried=False), list[dict[str, Any]]()
    with temporary_folder(within=folder) as files:
        unpack(resolved.files, files)
        for chunk in chunks(resolved, list(range(plan.count))):
            report(len(known), plan.count, "designs")
            known += [record["values"] | record["states"][0] for record in compute(chunk, files)]
    for each in known:
        low, high = map(each.get, ENDS)
        each[INTERVAL] = 50.0 * math.log(high / low) if low else None
    figures = {name: _grid([each.get(key) for each in known]) for name, (_, key) in MAPPED.items()}
    labels = {name: label for name, (label, _) in MAPPED.items()}
    return DesignMap(x, y, labels, figures, _grid([reason_words(each["message"]) for each in known]))


def _grid(column: list[Any]) -> list[list[Any]]:
    """Values of all designs by x and y, to the digits of the page."""
    return [rounded(column[k : k + GRID], _MAP_DIGITS) for k in range(0, len(column), GRID)]
