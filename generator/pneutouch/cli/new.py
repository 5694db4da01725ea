"""``pneutouch new``: a design file to start from, or a copy of what is shipped."""

from pathlib import Path
from typing import Annotated

from pneutouch.catalogue import Library
from pneutouch.catalogue.printers import makers
from pneutouch.cli.app import DesignFolderOption, SetOption, app, changes, design_folder
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import echo, notify, report_next
from pneutouch.errors import InputError
from pneutouch.spec.material import Material

parameter = parameters_of(__file__)


@app.command()
def new(
    name: Annotated[str | None, parameter("name")] = None,
    from_: Annotated[str | None, parameter("from")] = None,
    set_: SetOption = None,
    process: Annotated[str | None, parameter("process")] = None,
    material: Annotated[str | None, parameter("material")] = None,
    shape: Annotated[str | None, parameter("shape")] = None,
    drawing: Annotated[Path | None, parameter("drawing")] = None,
    pad: Annotated[str | None, parameter("pad")] = None,
    pitch: Annotated[float | None, parameter("pitch")] = None,
    out: DesignFolderOption = None,
) -> None:
    """Write a commented design file, or copy a shipped file."""
    from pneutouch.output.new import NewFile, change_of_copy, drawn, new_design, new_from

    note, started = None, {"--process": process, "--material": material, "--shape": shape, "--drawing": drawing}
    of_pad = {"--pad": pad, "--pitch": pitch}
    if from_ is not None:
        given = " and ".join(flag for flag, value in {**started, **of_pad}.items() if value is not None)
        if given:
            remedy = change_of_copy(from_)
            raise InputError(f"{given} cannot be given with a copy", key="from", value=from_, remedy=remedy)
        made = new_from(from_, name, out, changes(set_))
    elif name is not None and pad is not None:
        from pneutouch.output.new_pad import new_pad

        if drawing is not None:
            raise InputError(
                "is of one sensor",
                key="drawing",
                value=str(drawing),
                remedy="draw the cell first and name it in the pad",
            )
        path, cell, note = new_pad(name, design_folder(out), pad, pitch, process, material, changes(set_), shape)
        echo(str(cell))
        made = NewFile(path, ("check", name if out is None else str(path)))
    elif pitch is not None:
        raise InputError("is the distance of the cells of a pad", key="pitch", value=pitch, remedy="give `pad` too")
    elif name is not None:
        path, note = new_design(name, design_folder(out), process, material, drawn(changes(set_), shape, drawing))
        made = NewFile(path, ("check", name if out is None else str(path)))
    else:
        raise InputError("no name for the new design", remedy="give a name, or an example with `from`")
    echo(str(made.path))
    if note is not None:
        notify(note)
    if made.profile is None:
        report_next(*made.command, first=made.first)
        return

    command, first = next_of_profile(made.profile, made.path)
    report_next(*command, first=first)


def next_of_profile(kind: str, path: Path) -> tuple[tuple[str, ...], str]:
    """The next command for a copy of ``kind`` at ``path``, and the step by hand before it."""
    name = path.stem
    if kind == "printers":
        return ("coupons", "--profile", name), f"put the title, the resins and the numbers of your machine into {path}"
    if kind == "gauges":
        command = ("predict", "paper-dome", "--set", f"pneumatics.gauge={name}")
        return command, f"put the title and the numbers of your gauge into {path}"
    library = Library.default()
    material: Material = library.load("materials", name)
    first = f"put the title, the code and the numbers of your material into {path}"
    if material.kind == "elastomer" and makers(material, library):
        return ("new", f"{name}-dome", "--material", name), first
    return ("list", "materials"), first
