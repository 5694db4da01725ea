"""Write a new file to start from: a commented design, or a copy of a design, a specimen, an example or a profile."""

import os
from dataclasses import dataclass, replace
from itertools import chain, count
from pathlib import Path

from pneutouch.catalogue import KINDS, DesignSource, Library, user_folder
from pneutouch.catalogue.examples import COMMANDS, examples
from pneutouch.catalogue.library import is_specimen
from pneutouch.errors import InputError, nearest
from pneutouch.output.files import create_file, replace_file
from pneutouch.spec.design import DesignFile
from pneutouch.spec.files import is_file, read_bytes
from pneutouch.spec.names import plain_name
from pneutouch.spec.read import Changes, override, read_toml
from pneutouch.spec.template import design_template

PROFILES = ("printers", "gauges", "materials")
"""Kinds of files of a laboratory's own next to its designs."""

_DRAWN = ("designs", "specimens")
"""Kinds of files that describe printed things."""


@dataclass(frozen=True, slots=True)
class NewFile:
    """A file that was written, and the words of the command that takes it: ``("select", "fingertip.toml")``.

    ``first`` says what has to be done before that command. ``profile`` is its kind where it is one of `PROFILES`,
    for which there is no command of two words."""

    path: Path
    command: tuple[str, ...]
    first: str = ""
    profile: str | None = None


def new_design(
    name: str, folder: Path, process: str | None = None, material: str | None = None
) -> tuple[Path, str | None]:
    """Write ``folder/name.toml`` with every key, its default, unit, bounds and help; never over a file.

    With ``process`` or ``material`` the design starts with a profile that runs it, and which that is is stated next to
    the path. Raises InputError if none does.
    """
    if process is None and material is None:
        return write_design(name, folder, design_template(name)), None
    from pneutouch.output.new_process import process_values, profile_note

    library = Library.default()
    values = process_values(process, material, library)
    note = "Every key may be left out; shown are the defaults but for what process and resin need."
    path = write_design(name, folder, design_template(name, values, note))
    return path, profile_note(values, library, process=process, material=material)


def new_changed(source: DesignSource, name: str, folder: Path, *, overwrite: bool = False) -> Path:
    """Write a design as it is now, every key with its value, as ``folder/name.toml``; over a file with ``overwrite``
    alone. Raises InputError."""
    values = source.changed({}).model_dump(by_alias=True)
    text = design_template(name, values, "Every key may be left out.")
    return write_design(name, folder, text, overwrite=overwrite)


def new_from(source: str, name: str | None = None, out: Path | None = None, changes: Changes | None = None) -> NewFile:
    """Copy a design, a specimen, an example, a printer, a gauge or a material, by name, to a new name.

    A design or a specimen may be given by its path.

    The copy goes to ``out``, else an example to the working folder and all others to the user's folder, where they are
    found by their names; ``name`` left out is the example's own. ``changes`` are of a design alone, and printers,
    gauges and materials go to the user's folder alone. Never over a file. Raises InputError.
    """
    library, shipped = Library.default(), examples()
    kind = _profile_kind(source, library)
    if kind is not None:
        return _own_profile(kind, source, name, out, changes, library)
    if changes:
        return _changed(DesignSource.of(source, library), changes, name, out)
    for one in _DRAWN:
        if source in library.paths(one):
            return _copied(one, library.paths(one)[source], name, out)
    if source in shipped:
        example = shipped[source]
        called, text = plain_name(name or source, key="name"), example.path.read_text(encoding="utf-8")
        if example.kind == "campaign":
            # The runs of a campaign lie in the folder of its file.
            path = (out or Path()) / called / "campaign.toml"
            create_file(path, text.encode())
            first = f"put the files of your runs into {path.parent} and name them in {path}"
            return NewFile(path, (COMMANDS[example.kind], str(path.parent)), first)
        path = (out or Path()) / f"{called}.toml"
        create_file(path, text.encode())
        return NewFile(path, (COMMANDS[example.kind], str(path)))
    path = Path(source)
    if path.suffix == ".toml" or is_file(path):
        return _copied("specimens" if is_specimen(read_toml(path)) else "designs", path, name, out)
    known = dict.fromkeys([*shipped, *(name for one in (*_DRAWN, *PROFILES) for name in library.paths(one))])
    problem = f"no such design, specimen, example, printer, gauge or material.{nearest(source, known)}"
    raise InputError(problem, key="from", value=source)


def change_of_copy(source: str) -> str:
    """Remedy that shows how to change a copy of a name. Raises InputError as `new_from` does for a name of two
    kinds."""
    kind = _profile_kind(source, Library.default())
    return "change it with `set`" if kind is None else f"it is one of the {kind}: change the file of the copy"


def _profile_kind(source: str, library: Library) -> str | None:
    """The kind of profile that a name stands for; None if it stands for a printed thing, an example or nothing.

    Raises InputError if it stands for several, one of them a profile.
    """
    kinds = [one for one in (*_DRAWN, *PROFILES) if source in library.paths(one)]
    owners = [f"{one} ({library.paths(one)[source]})" for one in kinds]
    if source in examples():
        kinds, owners = ["examples", *kinds], ["examples", *owners]
    profiles = [one for one in kinds if one in PROFILES]
    if profiles and len(kinds) > 1:
        problem = f"stands for one of the {' and one of the '.join(owners)}"
        raise InputError(problem, key="from", value=source, remedy="give the one to copy a name of its own")
    return profiles[0] if profiles else None


def _own_profile(
    kind: str, source: str, name: str | None, out: Path | None, changes: Changes | None, library: Library
) -> NewFile:
    """A copy of a printer profile, a gauge or a material in the user's folder."""
    if changes:
        problem = f"{source} is one of the {kind}, and this changes a design"
        raise InputError(problem, key="set", remedy="change the file of the copy")
    if out is not None:
        remedy = f"leave it out: a copy of one of the {kind} is found in {KINDS[kind].folder} of your folder alone"
        raise InputError("is of designs, specimens and examples", key="out", value=str(out), remedy=remedy)
    written = _copied(kind, library.paths(kind)[source], name, None).path
    return NewFile(written, (), profile=kind)


def _changed(source: DesignSource, changes: Changes, name: str | None, out: Path | None) -> NewFile:
    if name is None:
        raise _nameless(source.name)
    changed = replace(source, content=override(source.content, changes, DesignFile))
    written = new_changed(changed, name, out or user_folder() / KINDS["designs"].folder)
    return NewFile(written, ("check", name if out is None else str(written)))


def _nameless(original: str) -> InputError:
    return InputError(f"{original} is the name of the original", key="name", remedy="give the copy another name")


def _copied(kind: str, path: Path, name: str | None, out: Path | None) -> NewFile:
    KINDS[kind].validate(read_toml(path), str(path))
    if name is None:
        raise _nameless(path.stem)
    folder = out or user_folder() / KINDS[kind].folder
    written = write_design(name, folder, read_bytes(path).decode("utf-8-sig"), kind)
    # A name finds what lies in the user's folder alone.
    return NewFile(written, ("check", name if out is None else str(written)))


def free_name() -> str:
    """A name that no design has, of the user's or shipped."""
    known = Library.default().paths("designs")
    return next(name for name in chain(["my-sensor"], (f"my-sensor-{k}" for k in count(2))) if name not in known)


def check_name(name: str, folder: Path, kind: str = "designs") -> Path:
    """The file of a new design. Raises InputError for a bad name, and for one that would hide another design."""
    path = folder / f"{plain_name(name, key='name')}.toml"
    known = Library.default().paths(kind).get(name)
    if known is not None and known.resolve() != path.resolve():
        problem = f"{known} is a {kind.removesuffix('s')} of this name, which the new file would hide"
        raise InputError(problem, key="name", value=name, remedy="give another name")
    return path


def check_free(name: str, folder: Path, *, overwrite: bool = False) -> Path:
    """The file of a new design, before anything is computed for it.

    Raises InputError as `check_name` does, for a file that is there already (but with ``overwrite``), and for a folder
    that cannot be written.
    """
    path = check_name(name, folder)
    if path.is_dir():
        raise InputError("this is a folder", file=path, remedy="give another name")
    if not overwrite and (path.exists() or path.is_symlink()):
        problem = "there is such a file already"
        raise InputError(problem, file=path, remedy="give another name, or `overwrite` to replace it")
    parent = next(one for one in (folder, *folder.absolute().parents) if one.exists())
    if not parent.is_dir():
        raise InputError(f"{parent} is not a folder", file=path)
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{parent} cannot be written", file=path, remedy="give a folder you may write to with `out`")
    return path


def write_design(name: str, folder: Path, text: str, kind: str = "designs", *, overwrite: bool = False) -> Path:
    """Write the text of a design as ``folder/name.toml``; over a file with ``overwrite`` alone."""
    path = check_name(name, folder, kind)
    (replace_file if overwrite else create_file)(path, text.encode())
    return path
