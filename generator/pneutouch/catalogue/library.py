"""The library: every kind of thing is a folder of TOML files, and a file's name is the thing's name.

Files in the user's folder come before the shipped ones, so a lab's own printer profile overrides ours. Points of a
sweep and resins of a selection read every file once (`CachedLibrary`).
"""

import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar, cast, get_args

from pydantic import BaseModel

from pneutouch.errors import InputError, nearest, one_line
from pneutouch.spec.design import DesignFile
from pneutouch.spec.files import exists, is_file
from pneutouch.spec.grade import MixingCurve
from pneutouch.spec.material import Material
from pneutouch.spec.part import AnyMount, AnySeat, Port, Tube
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import read_toml, validate

HOME = "PNEUTOUCH_HOME"
"""Environment variable that names the user's folder."""

IN_CHECKOUT = "user"
"""The user's folder inside a checkout of the program, whose own ``designs`` are the shipped ones; git ignores it."""

PACKAGE = Path(__file__).resolve().parents[1]
_CHECKOUT = PACKAGE.parents[1]


def shipped_root() -> Path:
    """The folder of the shipped files, ``designs`` and ``printprofiles``: the installed data, else the checkout."""
    installed = PACKAGE / "data"
    return installed if installed.is_dir() else _CHECKOUT


def user_folder() -> Path:
    """The folder that holds the user's ``designs``, ``calibrations`` and ``printprofiles``.

    It is ``$PNEUTOUCH_HOME``, else the working folder; in a checkout of the program, whose folders of these names are
    shipped, it is ``user/``. The last two are relative paths, so that messages stay short. Raises InputError.
    """
    named = os.environ.get(HOME)
    if named:
        try:
            return Path(named).expanduser()
        except RuntimeError:
            raise InputError("no such user", key=HOME, value=named, remedy="give the path of a folder") from None
    return Path(IN_CHECKOUT) if Path("generator/pneutouch/catalogue", Path(__file__).name).is_file() else Path()


FOLDER = "docs/examples"

_KINDS = {"target": "target", "entry": "tray", "grid": "sweep", "point": "sweep", "runs": "campaign"}
"""Kind of file by a key that only files of this kind have."""

COMMANDS = {"target": "select", "tray": "tray", "sweep": "sweep", "campaign": "characterize"}
"""Command that takes an example file, by the kind of the file."""


@dataclass(frozen=True, slots=True)
class Example:
    """An example: its file, the kind of the file, and its title, from the first line."""

    path: Path
    kind: str
    title: str


def examples() -> dict[str, Example]:
    """The shipped examples by name."""
    return {path.stem: _example(path) for path in sorted((shipped_root() / FOLDER).glob("*.toml"))}


def example_remedy(name: str) -> str | None:
    """Remedy with the command that copies the shipped example ``name``; None if there is no such example."""
    name = name.removesuffix(".toml")
    example = examples().get(name)
    if example is None:
        return None
    what = f"a {example.kind} file for {COMMANDS[example.kind]}"
    return f"the example of this name, {what}, is copied by `pneutouch new --from {name}`"


def read_given(path: Path, otherwise: str) -> dict[str, Any]:
    """Content of a TOML file that a user gave. Raises InputError; for a missing file its remedy is the example of this
    name, if there is one, else ``otherwise``."""
    try:
        return read_toml(path)
    except InputError as error:
        if not exists(path):
            error.remedy = example_remedy(str(path)) or otherwise
        raise


def _example(path: Path) -> Example:
    content = read_toml(path)
    kind = next(kind for key, kind in _KINDS.items() if key in content)
    title, _, _ = path.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ").partition(": ")
    return Example(path, kind, title)


Model = TypeVar("Model", bound=BaseModel)

ValidateFile = Callable[[dict[str, Any], str], BaseModel]
"""Validates a file's content; the second argument names the file. Raises InputError that names the key."""


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of thing: the validator of its files and their folder; ``part``: True if the package holds some too."""

    validate: ValidateFile
    folder: str
    part: bool = False


def _one(model: type[BaseModel]) -> ValidateFile:
    return lambda content, where: validate(model, content, where)


def _specimen(content: dict[str, Any], where: str) -> BaseModel:
    # A third of all models of files: a sensor loads none of them.
    from pneutouch.spec.specimen import validate_specimen

    return validate_specimen(content, where)


def _pad(content: dict[str, Any], where: str) -> BaseModel:
    from pneutouch.spec.pad import PadFile

    return validate(PadFile, content, where)


def _pad_calibration(content: dict[str, Any], where: str) -> BaseModel:
    from pneutouch.spec.pad import PadCalibration

    return validate(PadCalibration, content, where)


def _calibration(content: dict[str, Any], where: str) -> BaseModel:
    from pneutouch.spec.calibration import SensorCalibration

    return validate(SensorCalibration, content, where)


def _gauge(content: dict[str, Any], where: str) -> BaseModel:
    from pneutouch.spec.gauge import Gauge

    return validate(Gauge, content, where)


def _by_family(union: Any) -> ValidateFile:
    """Validator of files by the model of the ``family`` that each file names, out of a union of models."""
    models: dict[str, type[BaseModel]] = {
        family: one for one in get_args(union) for family in get_args(one.model_fields["family"].annotation)
    }

    def check(content: dict[str, Any], where: str) -> BaseModel:
        family = content.get("family")
        if not isinstance(family, str) or family not in models:
            raise InputError(f"unknown.{nearest(str(family), models)}", file=where, key="family", value=family)
        return validate(models[family], content, where)

    return check


KINDS: dict[str, FileKind] = {
    "designs": FileKind(_one(DesignFile), "designs"),
    "specimens": FileKind(_specimen, "designs/specimens"),
    "pads": FileKind(_pad, "designs/pads"),
    "calibrations": FileKind(_calibration, "calibrations"),
    "pad-calibrations": FileKind(_pad_calibration, "calibrations/pads"),
    "materials": FileKind(_one(Material), "printprofiles/materials"),
    "mixing": FileKind(_one(MixingCurve), "printprofiles/mixing"),
    "printers": FileKind(_one(Printer), "printprofiles"),
    "gauges": FileKind(_gauge, "printprofiles/gauges"),
    "tubes": FileKind(_one(Tube), "parts/tubes", part=True),
    "ports": FileKind(_by_family(Port), "parts/ports", part=True),
    "seats": FileKind(_by_family(AnySeat), "parts/seats", part=True),
    "mounts": FileKind(_by_family(AnyMount), "parts/mounts", part=True),
}


@dataclass(frozen=True, slots=True)
class Library:
    """All files that can be named: ``folders`` are searched in order, for parts the package last; first hit wins."""

    folders: tuple[Path, ...]

    @staticmethod
    def default() -> "Library":
        """The user's folder, then the shipped one."""
        return Library((user_folder().absolute(), shipped_root()))

    def paths(self, kind: str) -> dict[str, Path]:
        """Names of one kind with their files, sorted by name."""
        entry = KINDS[kind]
        roots = (*self.folders, PACKAGE) if entry.part else self.folders
        content: dict[str, Path] = {}
        for root in roots:
            folder = root / entry.folder
            for path in sorted(folder.glob("*.toml")) if folder.is_dir() else ():
                content.setdefault(path.stem, path)
        return dict(sorted(content.items()))

    def load(self, kind: str, name: str, *, file: str | None = None, key: str | None = None) -> Any:
        """Load one thing by name. Raises InputError; ``file`` and ``key`` state in it where the name was written."""
        paths = self.paths(kind)
        if name not in paths:
            problem = f"no such name among the {kind}.{nearest(name, paths)}"
            raise InputError(
                problem if key else f"{one_line(name)}: {problem}", file=file, key=key, value=name if key else None
            )
        path = paths[name]
        return KINDS[kind].validate(read_toml(path), str(path))

    def all(self, kind: str, model: type[Model]) -> dict[str, Model]:
        """Load everything of one kind; ``model`` is the kind's model, for the type checker."""
        return {name: cast(Model, self.load(kind, name)) for name in self.paths(kind)}

    def readable(self, kind: str, model: type[Model]) -> dict[str, Model]:
        """Load everything of one kind by name; invalid files, which a message must not propose, are left out."""
        content: dict[str, Model] = {}
        for name in self.paths(kind):
            with suppress(InputError):
                content[name] = cast(Model, self.load(kind, name))
        return content

    def design_file(self, name: str) -> Path:
        """The file of a design by name; a path, which need not exist. Raises InputError for an unknown name."""
        path, paths = Path(name), self.paths("designs")
        if name in paths:
            return paths[name]
        if path.suffix == ".toml" or "/" in name or is_file(path):
            return path
        if name in self.paths("specimens"):
            raise InputError(
                f"{name}: is a texture specimen; it can be built, checked and scanned, this command needs the design "
                "of a sensor"
            )
        if name in (pads := self.paths("pads")):
            cell = read_toml(pads[name]).get("pad", {}).get("cell")
            remedy = f"give its cell, {cell}" if isinstance(cell, str) else None
            raise InputError(
                "is a pad, and this command needs the design of one sensor", key="design", value=name, remedy=remedy
            )
        example, remedy = example_remedy(name), f"give the name or the path of a design.{nearest(name, paths)}"
        remedy = f"{example}; or {remedy}" if example else remedy
        raise InputError("no such design or file", key="design", value=name, remedy=remedy)

    def specimen_file(self, name: str) -> Path | None:
        """The file of a specimen given by name or path; None if the name is a sensor's or unknown."""
        return self._file_with("specimens", name, "block")

    def pad_file(self, name: str) -> Path | None:
        """The file of a pad given by name or path; None if the name is a sensor's or unknown."""
        return self._file_with("pads", name, "pad")

    def _file_with(self, kind: str, name: str, table: str) -> Path | None:
        files = self.paths(kind)
        if name in files:
            return files[name]
        try:
            path = self.design_file(name)
        except InputError:
            return None
        return path if is_file(path) and table in read_toml(path) else None


def is_specimen(content: dict[str, Any]) -> bool:
    """True if the content of a design file describes a specimen: it has a [block] table."""
    return "block" in content


@dataclass(frozen=True)
class CachedLibrary(Library):
    """A library over ``folders`` that do not change while it is used; what it returns is immutable and shared."""

    _files: dict[str, dict[str, Path]] = field(default_factory=dict, repr=False, compare=False)
    _things: dict[tuple[str, str], Any] = field(default_factory=dict, repr=False, compare=False)

    def paths(self, kind: str) -> dict[str, Path]:
        """Names of one kind with their files, sorted by name."""
        if kind not in self._files:
            self._files[kind] = super().paths(kind)
        return self._files[kind]

    def load(self, kind: str, name: str, *, file: str | None = None, key: str | None = None) -> Any:
        """Load one thing by name, from its file only once. Raises InputError as `Library.load` does."""
        if (kind, name) not in self._things:
            self._things[kind, name] = super().load(kind, name, file=file, key=key)
        return self._things[kind, name]


Resins = dict[str, Material]
"""Materials by name."""


def elastomers(library: Library, casting: bool = False) -> Resins:
    """Every printed elastomer of a library by name; with ``casting`` also those that are cast."""
    materials = library.all("materials", Material)
    soft = {name: material for name, material in materials.items() if material.kind == "elastomer"}
    return {name: material for name, material in soft.items() if casting or not material.is_cast}


def compared(library: Library, printer: Printer) -> Resins:
    """Elastomers that a printer makes, and those that the paper measured, which the model's error is taken from."""
    known = elastomers(library, printer.is_casting)
    return {name: one for name, one in known.items() if one.measured is not None or printer.mode_for(one) is not None}
