"""A recipe: everything that a build follows from, as data that a 3MF carries and from which it can be redone."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

from pneutouch import __version__
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.elastomers import Resins
from pneutouch.evaluation.evaluate import Evaluation, PredictionOptions, evaluate_scene
from pneutouch.formats import KEY, format_of

SETTINGS = ("model", "closure", "clamp", "tolerance")
"""Names of the settings among a recipe's inputs."""


@dataclass(frozen=True)
class BuildRecipe:
    """A scene with every name resolved, the resins it is compared with, and the options of its prediction.

    ``version`` is that of the pneutouch that made it.
    """

    scene: ResolvedDesign
    resins: Resins
    options: PredictionOptions
    version: str = __version__

    @staticmethod
    def of(evaluation: Evaluation) -> BuildRecipe:
        """The recipe that an evaluation followed."""
        return BuildRecipe(evaluation.scene, evaluation.resins, evaluation.options)

    def inputs(self) -> dict[str, Any]:
        """Everything that the result depends on, as data; settings that the model does not use are null."""
        options = self.options
        return {
            "model": options.model,
            "closure": options.closure if options.model in ("membrane", "auto") else None,
            "clamp": options.clamp,
            "tolerance": options.tolerance if options.model == "auto" else None,
            **{key: _data(part) for key, part in scene_parts(self.scene).items()},
            "compared_resins": {name: _data(material) for name, material in self.resins.items()},
        }

    def document(self) -> dict[str, Any]:
        """The recipe as data."""
        return {KEY: format_of("recipe"), "name": self.scene.name, "version": self.version, "inputs": self.inputs()}

    def text(self) -> str:
        """The recipe as JSON on one line, ASCII alone: no reader of XML can change it."""
        return json.dumps(self.document(), sort_keys=True, allow_nan=False, separators=(",", ":"))


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
    """Fields of a scene with the catalogue's kind that each is of: ``membrane_material`` is one of the materials."""
    names = [field.name for field in fields(ResolvedDesign) if field.name not in ("name", "where")]
    return {name: f"{name.rpartition('_')[2]}s" for name in names}


OPTIONAL = ("calibration", "gauge", "mould_printer", "mould_material")
"""Fields of a scene that a recipe leaves out where they are None."""


def scene_parts(scene: ResolvedDesign) -> dict[str, Any]:
    """Parts of a scene, by field; without the optional parts that it does not have."""
    parts = {key: getattr(scene, key) for key in scene_kinds()}
    return {key: part for key, part in parts.items() if part is not None or key not in OPTIONAL}


def _data(model: Any) -> Any:
    return None if model is None else model.model_dump(mode="json")
