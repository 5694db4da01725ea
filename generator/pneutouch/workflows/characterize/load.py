"""Reading of a campaign's folder, or of one file, into curves; a file that fails does not stop the others.

Also options of a command or function that override [columns] and [format] of a campaign file."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, grouped
from pneutouch.bench.curve import curve_of
from pneutouch.bench.questions import RESET_KPA, RESET_SHARE, check_leak, check_unpressed, looks_absolute
from pneutouch.bench.reading import HAND, INJECTION, LEAK, PLATE, leak_rate, read_blocks, read_injection
from pneutouch.bench.record import Blocks, MeasuredCurve, Trace, trace
from pneutouch.bench.source import MeasuredFile, MissingChannelError, as_option, campaign_lines, identify
from pneutouch.catalogue import ResolvedDesign
from pneutouch.catalogue.library import example_remedy
from pneutouch.errors import InputError, PneutouchError
from pneutouch.evaluation.resins import resin_of
from pneutouch.output.files import file_digest
from pneutouch.results.measured import ReadFiles
from pneutouch.spec.campaign import AS_DESIGNED, Campaign, CampaignRun, ColumnMap, FileFormat, RunKind, campaign_of
from pneutouch.spec.files import exists, is_file
from pneutouch.spec.read import validate
from pneutouch.spec.values import file_name
from pneutouch.tables.unit_words import ABSOLUTE, UNITS, unit_of
from pneutouch.units import KPA, STANDARD_ATMOSPHERE
from pneutouch.wording import listed

Reading = Mapping[str, Mapping[str, Any]]
"""Tables ``columns`` and ``format`` as in a campaign file; their keys override the campaign's."""

_CHANNELS = "|".join(UNITS)
_NEXT = re.compile(rf",(?=\s*(?:{_CHANNELS})\s*=)")
_NAMED = 12
"""Greatest number of files that are named, in a group that does not hold all files."""

_FORM = "write channel=NAME or channel=NAME:UNIT, such as force=Load or force=Load:N; -NAME turns the sign"


def parse_columns(texts: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Table [columns] from texts ``channel=NAME:UNIT``, each one or several with commas. Raises InputError for other
    texts.

    The unit may be left out where the header gives it; a minus before the name turns the sign."""
    columns: dict[str, dict[str, Any]] = {}
    for text in (part for whole in texts for part in _NEXT.split(whole)):
        channel, equals, name = (part.strip() for part in text.partition("="))
        if not equals or not name.strip("-") or channel not in UNITS:
            remedy = f"{_FORM}; channels: {', '.join(UNITS)}"
            raise InputError("no column of a channel", key="columns", value=text, remedy=remedy)
        sign, name = (-1, name[1:]) if name.startswith("-") else (1, name)
        label, colon, word = name.rpartition(":")
        known = unit_of(word) if colon and label else None
        unit = known[1] if known and known[0] == channel else ""
        columns[channel] = {"name": label.strip() if unit else name, "unit": unit, "sign": sign}
    return columns


def with_reading(campaign: Campaign, reading: Reading | None) -> Campaign:
    """The campaign with the keys of ``reading`` over its columns and format, and over those of its runs."""
    if not reading:
        return campaign
    runs = []
    for run in campaign.runs:
        tables = run.columns or ColumnMap(), run.format or FileFormat()
        is_plain = run.columns is None and run.format is None
        runs.append(run if is_plain else run.model_copy(update=_with_stated(*tables, reading, run.file)))
    return campaign.model_copy(update={**_with_stated(campaign.columns, campaign.format, reading), "runs": runs})


def _with_stated(
    columns: ColumnMap, written: FileFormat, reading: Reading, file: str = ""
) -> dict[str, ColumnMap | FileFormat]:
    """Columns and format of the campaign or of the run in ``file``, overridden by ``reading``. Raises InputError."""
    stated = {key: getattr(columns, key).model_dump() for key in columns.model_fields_set}
    try:
        merged = validate(ColumnMap, {**stated, **reading.get("columns", {})}, "")
    except InputError as error:
        where = f"with the columns of {file} in the campaign: " if file else ""
        raise InputError(f"{where}{error}", key="columns") from None
    how = validate(FileFormat, {**written.model_dump(exclude_none=True), **reading.get("format", {})}, "")
    return {"columns": merged, "format": how}


def read_as(sources: Mapping[str, MeasuredFile], runs: int) -> tuple[ReadFiles, ...]:
    """Layouts that were guessed for the files of a campaign of ``runs`` runs: files read alike together, with the
    tables of a campaign file that would state the layout."""
    alike = grouped((campaign_lines(one.content), file) for file, one in sources.items() if one.guessed)
    tables = [(sources[files[0]].content, tuple(files)) for files in alike.values()]
    return tuple(
        ReadFiles(columns=each.columns, format=each.format, files=files, whole_campaign=len(files) == runs)
        for each, files in tables
    )


def undisputed(sources: Mapping[str, MeasuredFile], failures: Sequence[tuple[str, str]]) -> dict[str, MeasuredFile]:
    """Files whose columns none of the failures, (file, message), puts in question."""
    disputed = {file for file, message in failures if "columns." in message}
    return {file: source for file, source in sources.items() if file not in disputed}


def same_failures(failures: Iterable[Sequence[str]]) -> list[tuple[str, str]]:
    """Failures, (file, message), grouped by message: names of the files, and the message without them."""
    alike: dict[str, list[str]] = {}
    for file, message in failures:
        _, named, problem = message.partition(f"{file}: ")
        alike.setdefault(problem if named else message, []).append(file)
    return [(listed(files, _NAMED), problem) for problem, files in alike.items()]


def reading_text(read_as: Iterable[ReadFiles]) -> str:
    """Notes on columns and formats that were guessed, with the lines that would state them in campaign.toml."""
    blocks = []
    for entry in read_as:
        files, whole = entry.files, entry.whole_campaign
        named = listed(files, 1 if whole else _NAMED)
        place = "into campaign.toml" if whole else "below the [[runs]] entry of each of these files in campaign.toml"
        lines = campaign_lines(entry, "" if whole else "runs.")
        blocks.append(f"note: {named}: read as follows; to keep it, put it {place}\n{lines}")
    return "\n".join(blocks).rstrip()


Progress = Callable[[int, int], None]
"""Called with the megabytes read and the megabytes in all."""

_MEGABYTE = 1e6
_LONGEST = 60

_LOADED, _COPY, _COMPARED = 0.1, 0.5, 20_000
"""Share of its greatest force above which a run counts as loaded; share of readings under load that two runs share,
force and pressure alike, above which one may be a copy of the other; most readings that are compared: our choice. Noise
makes hardly any two readings the same."""

_ROUNDED = 5e-5
"""Greatest difference of all readings of two runs, as a share of the greatest, up to which one is the other rounded."""


@dataclass
class CampaignData:
    """Content of a campaign's files, gathered as they are read.

    Attributes:
        campaign: The campaign, its runs with the kinds as read; for a single file a campaign of that run.
        folder: Folder of the campaign's files.
        curves: Curves of every run with a plate that could be read, in the campaign's order.
        traces: Runs with a plate or a leak, thinned for plotting, by file.
        injections: Run, volumes (mm3) and pressures (MPa) of the injection runs.
        leaks: Run, leak rate and its standard error (MPa/s) of the leak runs.
        failures: Files that could not be read, with the message.
        questions: Data that look wrong when read, before a prediction: file, and the question.
        sources: The files that could be identified, with their columns as they were read.
        digests, readings: Files by their content, and their readings under load, to find copies.
    """

    campaign: Campaign
    folder: Path
    curves: list[MeasuredCurve] = field(default_factory=list)
    traces: dict[str, Trace] = field(default_factory=dict)
    injections: list[tuple[CampaignRun, Array, Array]] = field(default_factory=list)
    leaks: list[tuple[CampaignRun, float, float]] = field(default_factory=list)
    failures: list[tuple[str, str]] = field(default_factory=list)
    questions: list[tuple[str, str]] = field(default_factory=list)
    sources: dict[str, MeasuredFile] = field(default_factory=dict)
    digests: dict[str, str] = field(default_factory=dict)
    readings: dict[str, NDArray[np.complex128]] = field(default_factory=dict)

    def first_of(self, path: Path, file: str) -> str | None:
        """An earlier file with the same bytes; None if there is none."""
        digest = file_digest(path)
        first = file if digest is None else self.digests.setdefault(digest, file)
        return None if first == file else first

    def much_of(self, file: str, blocks: Blocks) -> str | None:
        """An earlier file that has most of this one's readings under load; None if there is none."""
        under_load = np.abs(blocks.force) > _LOADED * np.abs(blocks.force).max()
        readings = (blocks.force + 1j * blocks.pressure)[under_load][:_COMPARED]

        def same(known: NDArray[np.complex128]) -> bool:
            """True for a copy, with fewer decimals too."""
            alike = known.size == readings.size and np.abs(known - readings).max() < _ROUNDED * np.abs(readings).max()
            return bool(alike or np.isin(readings, known).mean() > _COPY)

        copied = (name for name, known in self.readings.items() if same(known))
        first = next(copied, None) if readings.size else None
        self.readings[file] = readings
        return first


def load_curves(
    data: Path,
    scene: ResolvedDesign | None = None,
    progress: Progress = lambda done, total: None,
    reading: Reading | None = None,
    kind: RunKind | None = None,
    *,
    of_the_day: bool = False,
) -> CampaignData:
    """Read a campaign's folder, its campaign file, or one file of a run; ``reading`` overrides the campaign.

    A single file has the ``kind`` given, else the one it shows, the resin of the design ``scene``, and that driving
    pressure of the design which was read before contact. ``of_the_day``: the ambient pressure of ``scene`` was stated
    for these files, and precedes the campaign's. Raises InputError if the campaign is wrong, or no file can be read.
    """
    if data.is_dir() or data.suffix == ".toml":
        campaign, folder = campaign_of(data)
        if kind is not None:
            raise InputError("given for a campaign", key="kind", value=kind, remedy="state it in its [[runs]] entries")
    else:
        campaign, folder = _single(data, scene, kind), data.parent
    campaign = with_reading(campaign, reading)
    if scene is not None:
        own = {"resin": resin_of(scene)}
        runs = [run.model_copy(update=own) if run.resin == AS_DESIGNED else run for run in campaign.runs]
        ambient = {"ambient_pressure_kPa": scene.design.pneumatics.ambient_pressure_kPa} if of_the_day else {}
        campaign = campaign.model_copy(update={"runs": runs, **ambient})
    gathered = CampaignData(campaign, folder)
    ambient_kPa = campaign.ambient_pressure_kPa
    if ambient_kPa is None:
        ambient_kPa = STANDARD_ATMOSPHERE / KPA if scene is None else scene.design.pneumatics.ambient_pressure_kPa
    paths = [folder / run.file for run in campaign.runs]
    sizes = [path.stat().st_size if is_file(path) else 0 for path in paths]
    total = max(round(sum(sizes) / _MEGABYTE), 1)
    for place, run in enumerate(campaign.runs):

        def report(share: float, before: float = sum(sizes[:place]), size: float = sizes[place]) -> None:
            progress(round((before + share * size) / _MEGABYTE), total)

        try:
            _read(run, gathered, report, ambient_kPa * KPA)
        except PneutouchError as error:
            gathered.failures.append((run.file, str(error)))
        report(1.0)
    if not (gathered.curves or gathered.injections or gathered.leaks):
        failures = same_failures([(str(folder / file), text) for file, text in gathered.failures])
        lines = [f"{files}: {text}" for files, text in failures]
        raise InputError("\n".join([f"{data}: none of its files can be read", *lines]))
    if not (data.is_dir() or data.suffix == ".toml"):
        assert scene is not None
        gathered.curves = [_at_its_pressure(curve, scene, gathered) for curve in gathered.curves]
    as_read = {curve.run.file: curve.run for curve in gathered.curves}
    as_read |= {run.file: run for run, *_ in (*gathered.injections, *gathered.leaks)}
    gathered.campaign = campaign.model_copy(update={"runs": [as_read.get(run.file, run) for run in campaign.runs]})
    return gathered


def _read(run: CampaignRun, gathered: CampaignData, progress: Callable[[float], None], ambient: float) -> None:
    campaign, folder = gathered.campaign, gathered.folder
    source = gathered.sources[run.file] = recognise(run, campaign, folder)
    if (first := gathered.first_of(folder / run.file, run.file)) is not None:
        raise InputError(
            f"the same bytes as {first}: one recording is no two runs", file=folder / run.file, remedy="leave one out"
        )
    run = _of_its_channels(run, source)
    if run.kind == "injection":
        gathered.injections.append((run, *read_injection(source, ambient)))
        return
    if source.columns.pressure.unit.endswith(ABSOLUTE) and campaign.ambient_pressure_kPa is None:
        said = f"the design's ambient pressure of {ambient / KPA:.6g} kPa is subtracted"
        day = f"was it that of the day? State it by `pneumatics.ambient_pressure_kPa`={ambient / KPA:.6g}"
        gathered.questions.append((run.file, f"{said}: {day}, or in a campaign by ambient_pressure_kPa"))
    blocks = read_blocks(source, campaign.rig, progress, ambient)
    if (first := gathered.much_of(run.file, blocks)) is not None:
        gathered.questions.append((run.file, f"most of its readings are those of {first}: is it a copy of that run?"))
    gathered.traces[run.file] = trace(blocks)
    if run.kind == "leak":
        gathered.questions += [(run.file, text) for text in check_leak(blocks, run, campaign.rig)]
        gathered.leaks.append((run, *leak_rate(blocks.time, blocks.pressure)))
    else:
        gathered.curves.append(curve_of(run, blocks, campaign.rig))


_WITHOUT: dict[tuple[str, ...], tuple[RunKind, tuple[str, ...]]] = {
    ("position",): ("hand", HAND),
    ("position", "force"): ("leak", LEAK),
}
"""For channels that a file lacks of those of a run with a plate: the kind of its run, and the channels that it has."""


def recognise(run: CampaignRun, campaign: Campaign, folder: Path) -> MeasuredFile:
    """File of a run with its columns; no sample is read. A run without a stated kind has the channels that the file
    has. Raises InputError if the file or a column is not found."""
    path = folder / run.file
    if not exists(path):
        raise InputError("no such file", file=path, remedy="the campaign names it")
    channels = {"injection": INJECTION, "leak": LEAK, "hand": HAND}.get(run.kind, PLATE)
    columns, written = campaign.reading(run)
    try:
        return identify(path, columns, channels, written)
    except MissingChannelError as error:
        if "kind" in run.model_fields_set or error.channels not in _WITHOUT:
            raise
        return identify(path, columns, _WITHOUT[error.channels][1], written)


def _of_its_channels(run: CampaignRun, source: MeasuredFile) -> CampaignRun:
    """The run with the kind that its file's channels imply, as if read from the record; unchanged for a plate."""
    kind = next((kind for kind, channels in _WITHOUT.values() if channels == source.channels), None)
    if kind is None or run.kind == kind:
        return run
    # As if it were left out: the record tells it.
    told = run.model_copy(update={"kind": kind})
    told.model_fields_set.discard("kind")
    return told


def _single(data: Path, scene: ResolvedDesign | None, kind: RunKind | None) -> Campaign:
    if not data.exists():
        raise InputError("no such file or folder", file=data, remedy=example_remedy(str(data)))
    if scene is None:
        raise InputError("a single file needs its sensor", file=data, remedy="give `design`")
    run = CampaignRun(file=data.name, sensor=file_name(data.stem)[:_LONGEST], resin=resin_of(scene))
    if kind is not None:
        run = run.model_copy(update={"kind": kind})
    return Campaign(title=f"Run {file_name(data.name)}"[:_LONGEST], runs=[run])


def _at_its_pressure(curve: MeasuredCurve, scene: ResolvedDesign, gathered: CampaignData) -> MeasuredCurve:
    """Curve of a single file at the design's driving pressure near the one read; if none is, at that, with a question.

    Raises InputError for a pressure before contact that looks like an absolute one.
    """
    read_kPa = curve.driving / KPA
    stated_kPa = scene.design.pneumatics.driving_pressures_kPa
    nearest_kPa = min(stated_kPa, key=lambda p: abs(p - read_kPa))
    # Where a channel is late, that is asked about, and the pressure may be one of a press.
    near = curve.late is not None or abs(nearest_kPa - read_kPa) <= max(RESET_KPA, RESET_SHARE * nearest_kPa)
    column = gathered.sources[curve.run.file].columns.pressure
    units, declared = UNITS["pressure"], column.unit.removesuffix(ABSOLUTE)
    # In a smaller unit too: hectopascals under a heading of kilopascals are no driving pressure.
    smaller = [unit for unit in units if units[unit] < units[declared] and f"{unit}{ABSOLUTE}" in units]
    for unit in () if near else (declared, *smaller):
        if not any(looks_absolute(read_kPa * units[unit] / units[declared] - p) for p in (0.0, *stated_kPa)):
            continue
        raise InputError(
            f"{read_kPa:.4g} kPa before contact, which looks like an absolute pressure",
            file=curve.run.file,
            key=f"column {column.name}",
            remedy=as_option(pressure=column.model_copy(update={"unit": f"{unit}{ABSOLUTE}"}))
            + ", of which the ambient pressure of the design is subtracted",
        )
    found_kPa = nearest_kPa if near else round(max(read_kPa, 0.0), 1)
    if not near:
        check_unpressed(curve, min(stated_kPa), curve.run.file)
        problem = f"{read_kPa:.3g} kPa before contact is none of the design's driving pressures: is the gauge zeroed?"
        stated = f"`pneumatics.driving_pressures_kPa`={found_kPa:g}"
        if column.unit.endswith(ABSOLUTE) and read_kPa < 0.0:
            day_kPa = scene.design.pneumatics.ambient_pressure_kPa + read_kPa
            problem = f"an absolute pressure of {day_kPa:.4g} kPa before contact: was it the ambient one of the day?"
            stated = f"`pneumatics.ambient_pressure_kPa`={day_kPa:.4g}"
        if column.unit.endswith(ABSOLUTE) or read_kPa >= 0.0:
            gathered.questions.append((curve.run.file, f"{problem} If so, state it by {stated}"))
    return replace(curve, run=curve.run.model_copy(update={"driving_pressure_kPa": found_kPa}))
