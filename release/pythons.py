"""Install the wheel under every supported Python that is found here, and use it: ``make pythons``.

The source archive must give the same wheel. Each Python gets a virtual environment with the locked dependencies. The
commands of `SMOKE` must end well. ``--tests`` runs tests too, against the installed wheel.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NEWEST = 14
"""Minor version of the newest Python that is looked for."""

SMOKE = (
    ("-c", "import pneutouch as pt; print(pt.__version__, pt.load('paper-dome').predict(model='atlas').at(0))"),
    ("-m", "pneutouch", "predict", "paper-dome", "--json"),
    ("-m", "pneutouch", "check", "paper-dome"),
    ("-m", "pneutouch", "build", "paper-dome", "--out", "built"),
)


def supported() -> list[str]:
    """Versions of Python that are supported: from the least that pyproject.toml states up to `NEWEST`."""
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["requires-python"]
    least = int(re.fullmatch(r">=3\.(\d+)", stated)[1])
    return [f"3.{minor}" for minor in range(least, NEWEST + 1)]


def interpreter(version: str) -> str | None:
    """An interpreter of a version that runs: on the path, or of pyenv; None where there is none."""
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    places = [shutil.which(f"python{version}"), *sorted(map(str, root.glob(f"versions/{version}.*/bin/python")))]
    for place in places:
        # A shim of pyenv is on the path for versions that are not chosen, and fails.
        if place and answer(place) == version:
            return place
    return None


def answer(place: str) -> str:
    words = [place, "-c", "import sys; print('{}.{}'.format(*sys.version_info))"]
    return subprocess.run(words, capture_output=True, text=True, check=False).stdout.strip()


def wheel(folder: Path) -> Path:
    """The wheel, which the source archive must give with the same bytes: what holds for one holds for both."""
    (source,) = built("sdist", ROOT, folder / "sdist")
    with tarfile.open(source) as archive:
        archive.extractall(folder, filter="data")
    (direct,) = built("wheel", ROOT, folder / "wheel")
    (unpacked,) = built("wheel", folder / source.name.removesuffix(".tar.gz"), folder / "again")
    if direct.read_bytes() != unpacked.read_bytes():
        raise SystemExit(f"{direct.name}: of the checkout and of {source.name} differ")
    return direct


def built(kind: str, place: Path, folder: Path) -> list[Path]:
    words = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(folder)]
    known = os.environ | {"SOURCE_DATE_EPOCH": "1580601600"}
    subprocess.run(words, cwd=place, check=True, capture_output=True, env=known)
    return list(folder.iterdir())


def installed(place: str, folder: Path, package: Path, *, tests: bool) -> Path:
    """The Python of a virtual environment with the locked dependencies and the wheel; one that exists is kept."""
    python = folder / "bin" / "python"
    if not python.exists():
        subprocess.run([place, "-m", "venv", str(folder)], check=True)
    pip = [str(python), "-m", "pip", "--disable-pip-version-check", "--quiet", "install"]
    for lock in ("requirements.lock", *(["requirements-dev.lock"] if tests else [])):
        subprocess.run([*pip, "--require-hashes", "--requirement", str(ROOT / lock)], check=True)
    subprocess.run([*pip, "--no-deps", "--force-reinstall", str(package)], check=True)
    return python


def used(python: Path, tests: Sequence[str]) -> str:
    """Run the commands, then the tests; returns the last line of the tests. Raises SystemExit where one fails."""
    clean = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PNEUTOUCH_HOME")}
    with tempfile.TemporaryDirectory() as name:
        for words in SMOKE:
            run([str(python), "-I", *words], Path(name), clean)
    if not tests:
        return f"{len(SMOKE)} commands end well"
    # The checkout's root gives the tests; the package is that of the wheel.
    words = [str(python), "-m", "pytest", "--no-header", *tests]
    return run(words, ROOT, clean | {"PYTHONPATH": str(ROOT)}).strip().splitlines()[-1]


def run(words: Sequence[str], folder: Path, known: dict[str, str]) -> str:
    """What a program prints. Raises SystemExit with the end of its output where it fails."""
    done = subprocess.run(words, cwd=folder, env=known, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)}: exit code {done.returncode}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def main() -> int:
    """Exit code 1 where no supported Python is found."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tests", nargs="*", default=[], help="files or folders of tests to run against the wheel")
    parser.add_argument("--only", nargs="*", default=supported(), help="versions, such as 3.12")
    parser.add_argument("--folder", type=Path, help="keeps the virtual environments")
    given = parser.parse_args()
    available = {version: place for version in given.only if (place := interpreter(version))}
    missing = [each for each in given.only if each not in available]
    print(f"found: {', '.join(available) or 'none'}; not here: {', '.join(missing) or 'none'}", flush=True)
    with tempfile.TemporaryDirectory() as name:
        package = wheel(Path(name))
        print(f"{package.name}: the same bytes from the checkout and from the source archive", flush=True)
        for version, place in available.items():
            folder = (given.folder or Path(name)) / f"python{version}"
            python = installed(place, folder, package, tests=bool(given.tests))
            print(f"{version} ({place}): {used(python, given.tests)}", flush=True)
    return int(not available)


if __name__ == "__main__":
    sys.exit(main())
