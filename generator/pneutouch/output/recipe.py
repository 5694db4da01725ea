"""Recipe of a build: everything on which the build depends, as data that a 3MF carries, sufficient to redo it.

Nothing of a recipe that is read from a 3MF is used before it is validated.
"""

import datetime
import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any, NoReturn

from pneutouch import __version__
from pneutouch.catalogue import KINDS, ResolvedDesign, check_scene
from pneutouch.catalogue.library import Resins
from pneutouch.errors import InputError, nearest, shown
from pneutouch.evaluation.evaluate import CLAMPS, Evaluation, PredictionOptions, evaluate_scene
from pneutouch.export.threemf_read import Package
from pneutouch.formats import check_format, versioned
from pneutouch.mechanics.models.choice import CLOSURES, MODEL_CHOICES
from pneutouch.output.files import input_hash, versions
from pneutouch.spec.fields import Table
from pneutouch.spec.read import validate
from pneutouch.spec.values import is_finite, plain_name

SETTINGS = ("model", "closure", "clamp", "tolerance")
"""Names of the settings among a recipe's inputs."""


@dataclass(frozen=True)
class BuildRecipe:
    """A scene with every name resolved, the resins it is compared with, and the options of its prediction.

    ``version`` is the version of pneutouch that made the recipe.
    """

    scene: ResolvedDesign
    resins: Resins
    options: PredictionOptions
    version: str = __version__

    @staticmethod
    def of(evaluation: Evaluation) -> "BuildRecipe":
        """The recipe that an evaluation followed."""
        return BuildRecipe(evaluation.scene, evaluation.resins, evaluation.options)

    def inputs(self) -> Mapping[str, Any]:
        """Everything that the result depends on, as data; closure and tolerance are null if they have no effect."""
        options = self.options
        return {
            "model": options.model,
            "closure": options.closure if options.model in ("membrane", "auto") else None,
            "clamp": options.clamp,
            "tolerance": options.tolerance if options.model == "auto" else None,
            **{key: _data(part) for key, part in scene_parts(self.scene).items()},
            "compared_resins": {name: _data(material) for name, material in self.resins.items()},
        }

    def text(self) -> str:
        """The recipe as JSON on one line, in ASCII only, which no reader of XML changes."""
        content = {"name": self.scene.name, "version": self.version, "inputs": self.inputs()}
        return json.dumps(versioned("recipe", content), sort_keys=True, allow_nan=False, separators=(",", ":"))


def evaluate_recipe(recipe: BuildRecipe) -> Evaluation:
    """Draw and predict from a recipe; no library is read. Raises InputError that names the recipe's file."""
    where = recipe.scene.where
    try:
        return evaluate_scene(recipe.scene, partial(dict, recipe.resins), recipe.options)
    except InputError as error:
        if error.file is None and not str(error).startswith(where):
            error.file = where
        raise


def scene_kinds() -> dict[str, str]:
    """Kind in the catalogue by field of a scene: ``membrane_material`` is one of the ``materials``."""
    names = [field.name for field in fields(ResolvedDesign) if field.name not in ("name", "where")]
    return {name: f"{name.rpartition('_')[2]}s" for name in names}


OPTIONAL = ("calibration", "gauge", "mould_printer", "mould_material")
"""Fields of a scene that a recipe leaves out if they are None."""


def scene_parts(scene: ResolvedDesign) -> dict[str, Table | None]:
    """Parts of a scene, by field; without the optional parts that it does not have."""
    parts = {key: getattr(scene, key) for key in scene_kinds()}
    return {key: part for key, part in parts.items() if part is not None or key not in OPTIONAL}


def _data(model: Table | None) -> Any:
    return None if model is None else model.model_dump(mode="json")


FINEST_STEP = 1e-3
"""Least step in mm of a recipe's printers: none has a finer one, and meshes would grow without bound."""


def read_recipe(package: Package) -> BuildRecipe:
    """The recipe of a 3MF. Raises InputError if there is none, or if it is damaged, altered or of wrong values."""
    where = str(package.path)
    if package.recipe is None:
        raise InputError(
            "holds no recipe, so it cannot be rebuilt",
            file=where,
            remedy="give the NAME.3mf in a folder NAME that pneutouch build wrote, or a design file",
        )
    head = _head(package.recipe, f"{where}: recipe")
    inputs, kinds = head.inputs, scene_kinds()
    _check_keys(inputs, {*kinds, *SETTINGS, "compared_resins"}, f"{where}: recipe: inputs")
    there = {key: kind for key, kind in kinds.items() if key in inputs}
    parts = {key: _part(kind, inputs[key], f"{where}: recipe: {key}") for key, kind in there.items()}
    scene = ResolvedDesign(name=head.name, where=where, **parts)
    resins = _resins(inputs["compared_resins"], f"{where}: recipe: compared_resins")
    options = _options(inputs, f"{where}: recipe")
    check_scene(replace(scene, where=f"{where}: recipe"))
    _check_steps(scene, f"{where}: recipe")
    if package.metadata.get("input-hash") != input_hash(inputs, head.version):
        raise InputError(
            "recipe: altered or damaged: it does not match the input hash stored with it",
            file=where,
            remedy="take the file as it was built, or build from a design file",
        )
    return BuildRecipe(scene, resins, options, head.version)


class _Head(Table):
    """The outermost table of a recipe."""

    format: str
    name: str
    version: str
    inputs: dict[str, Any]


def _head(text: str, where: str) -> _Head:
    try:
        content = json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        why = "nested too deep" if isinstance(error, RecursionError) else str(error)
        raise InputError(
            f"damaged, not valid JSON: {why}", file=where, remedy="take the file as it was built"
        ) from None
    if not isinstance(content, dict):
        raise InputError("damaged: must be a table", file=where)
    check_format("recipe", content, where)
    head = validate(_Head, content, where)
    plain_name(head.name, file=where, key="name")
    if not head.version.isprintable() or len(head.version) > 40:
        raise InputError("must be a version number", file=where, key="version", value=head.version[:60])
    return head


def _no_number(word: str) -> NoReturn:
    raise ValueError(f"{word} is not a number")


def _check_keys(content: dict[str, Any], known: set[str], where: str) -> None:
    for key in sorted(content.keys() - known):
        raise InputError(f"{key}: unknown.{nearest(key, known)}", file=where)
    for key in sorted(known - content.keys() - {*OPTIONAL}):
        raise InputError(f"{key}: missing", file=where)


def _part(kind: str, content: Any, where: str) -> Any:
    """A part of a recipe, validated as the file of its kind would be."""
    if not isinstance(content, dict):
        raise InputError(f"{where} = {shown(content)}: must be a table")
    return KINDS[kind].validate(_dated(content) if kind == "designs" else content, where)


def _dated(content: dict[str, Any]) -> dict[str, Any]:
    """A design with its date as a date, as TOML gives it, for JSON has none; a wrong one is left for the validation."""
    document = content.get("document")
    if not isinstance(document, dict) or not isinstance(document.get("date"), str):
        return content
    try:
        date: Any = datetime.date.fromisoformat(document["date"])
    except ValueError:
        return content
    return {**content, "document": {**document, "date": date}}


def _resins(content: Any, where: str) -> Resins:
    if not isinstance(content, dict):
        raise InputError("must be a table of materials", file=where)
    resins = {name: _part("materials", content[name], f"{where}.{name}") for name in sorted(content)}
    for name, material in resins.items():
        if material.kind != "elastomer":
            raise InputError(f"{where}.{name}: {material.label} is {material.kind}; it must be elastomer")
    return resins


def _options(inputs: dict[str, Any], where: str) -> PredictionOptions:
    """Options of the prediction; a null stands for the default, which has no effect then."""
    model = _one_of(inputs, "model", MODEL_CHOICES, where)
    needed = {"closure": model in ("membrane", "auto"), "tolerance": model == "auto"}
    given: dict[str, Any] = {"model": model, "clamp": _one_of(inputs, "clamp", CLAMPS, where)}
    for key, used in needed.items():
        if used == (inputs[key] is None):
            raise InputError(
                f"{key} = {shown(inputs[key])}: must {'' if used else 'not '}be given with model {model}", file=where
            )
    if needed["closure"]:
        given["closure"] = _one_of(inputs, "closure", CLOSURES, where)
    if needed["tolerance"]:
        value = inputs["tolerance"]
        if not (is_finite(value) and 0 < value < 100):
            raise InputError(f"tolerance = {shown(value)}: must be a positive share, such as 0.02", file=where)
        given["tolerance"] = float(value)
    return PredictionOptions(**given)


def _one_of(inputs: dict[str, Any], key: str, known: Collection[str], where: str) -> str:
    value = inputs[key]
    if not isinstance(value, str) or value not in known:
        raise InputError(f"{key} = {shown(value)}: unknown.{nearest(str(value)[:60], known)}", file=where)
    return value


def _check_steps(scene: ResolvedDesign, where: str) -> None:
    """Raise InputError for steps finer than any printer has: meshes would grow without bound."""
    if scene.mesh_tolerance < FINEST_STEP:
        raise InputError(
            f"the printers step by {scene.mesh_tolerance:g} mm",
            file=where,
            remedy=f"their steps must be at least {FINEST_STEP:g} mm",
        )


def stored_versions(package: Package) -> Mapping[str, object]:
    """Versions by name that a 3MF states; empty if they are damaged, for no build depends on them."""
    try:
        stored = json.loads(package.metadata.get("versions", "{}"))
    except (ValueError, RecursionError):
        return {}
    return stored if isinstance(stored, dict) else {}


def other_versions(package: Package, recipe: BuildRecipe) -> list[str]:
    """Programs whose version was another when a 3MF was made, in words: ``pneutouch 0.1 (here 0.2)``."""
    made = {**stored_versions(package), "pneutouch": recipe.version}
    return [
        f"{name} {str(made[name])[:40]} (here {here})"
        for name, here in versions().items()
        if made.get(name, here) != here
    ]
