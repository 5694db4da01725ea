"""``pneutouch studio``: a page in the browser."""

import html
import tempfile
import threading
import webbrowser
from pathlib import Path
from typing import Annotated

from pneutouch.cli.app import app
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import echo, notify
from pneutouch.errors import InputError

parameter = parameters_of(__file__)


@app.command()
def studio(
    design: Annotated[str | None, parameter("design")] = None,
    port: Annotated[int, parameter("port")] = 0,
    no_browser: Annotated[bool, parameter("no_browser")] = False,
) -> None:
    """Open a page in the browser: change a design and see its drawing, curves and limits. Ctrl-C ends it."""
    try:
        import starlette  # noqa: F401
        import uvicorn  # noqa: F401
    except ImportError:
        remedy = "install them: pip install 'pneutouch[studio]'"
        raise InputError("the studio needs the packages starlette and uvicorn", remedy=remedy) from None
    from pneutouch.studio.server import serve

    with tempfile.TemporaryDirectory(prefix="pneutouch-studio-", ignore_cleanup_errors=True) as folder:

        def opened(address: str) -> None:
            echo(address)
            notify("note: the address opens the page once, on this machine; Ctrl-C ends the studio")
            if not no_browser:
                page = forwarding(address, Path(folder))
                # A browser in a terminal would return when it is left.
                threading.Thread(target=webbrowser.open, args=(page.as_uri(),), daemon=True).start()

        serve(design, port, opened)


def forwarding(address: str, folder: Path) -> Path:
    """Write a page that only the user can read into ``folder`` and that leads to the address; returns its path.

    Every user of the machine can read the command that starts a browser: so the address, with its token, is not in it.
    """
    page = folder / "open.html"
    page.touch(0o600)
    page.write_text(
        f'<!doctype html><meta charset="utf-8"><meta http-equiv="refresh" content="0; url={html.escape(address)}">'
        f'<title>pneutouch studio</title><a href="{html.escape(address)}">pneutouch studio</a>\n',
        encoding="utf-8",
    )
    return page
