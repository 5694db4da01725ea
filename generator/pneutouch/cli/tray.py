"""``pneutouch tray``: several sensors on one tray of a printer."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pneutouch.cli.app import JsonOption, OutOption, SetOption, app, changes, print_json
from pneutouch.cli.complete import assignment, parameters_of
from pneutouch.cli.terminal import echo, filled_text, notify
from pneutouch.errors import InputError
from pneutouch.wording import counted

if TYPE_CHECKING:
    from pneutouch.workflows.tray.order import TrayOrder

parameter = parameters_of(__file__)


@app.command()
def tray(
    what: Annotated[list[str], parameter("what")],
    over: Annotated[list[str] | None, parameter("over", autocompletion=assignment)] = None,
    copies: Annotated[int | None, parameter("copies")] = None,
    profile: Annotated[str | None, parameter("profile")] = None,
    marks: Annotated[str | None, parameter("marks")] = None,
    set_: SetOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Lay many sensors out on one tray: print files, part marks and a label list."""
    from pneutouch.output.files import check_writable
    from pneutouch.workflows.tray.lay import lay
    from pneutouch.workflows.tray.write import write_tray

    order = _order(what, over or [], copies, changes(set_), {"profile": profile, "marks": marks})
    folder = out / order.name
    check_writable(folder)
    record = write_tray(lay(order, progress=_report), folder, _report)
    for note in record.left_out:
        notify(f"not on this tray: {note}")
    if json:
        print_json(record)
    else:
        echo(filled_text("tray.txt.j2", record=record, counted=counted))
        echo(record.folder)


def _order(
    what: list[str], over: list[str], copies: int | None, changed: dict[str, Any], head: dict[str, str | None]
) -> "TrayOrder":
    """The order of a tray: from a tray file if the one word given is a file with an [[entry]], else from designs and
    flags."""
    from pneutouch.workflows.tray.order import is_tray_file, order_of_file, order_of_flags

    if len(what) == 1 and is_tray_file(Path(what[0])):
        if over or copies is not None:
            raise InputError(f"{what[0]}: a tray file and {'--over' if over else '--copies'}: put it into an [[entry]]")
        return order_of_file(Path(what[0]), changed, **head)
    return order_of_flags(what, over, 1 if copies is None else copies, changed, **head)


def _report(step: str) -> None:
    notify(f"{step} ...")
