"""``pneutouch respond``: a step or a sine of force or travel through the whole sensor, as a simulated signal."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pneutouch.cli import app as cli
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import bar, notify, report_next, set_words, table_text
from pneutouch.results.response import LoadResponse

if TYPE_CHECKING:
    from pneutouch.workflows.respond import Load

parameter = parameters_of(__file__)


@cli.app.command()
def respond(
    design: cli.DesignArgument,
    step: Annotated[str | None, parameter("step")] = None,
    sine: Annotated[str | None, parameter("sine")] = None,
    peak: Annotated[str | None, parameter("peak")] = None,
    duration: Annotated[float | None, parameter("duration")] = None,
    seed: Annotated[int, parameter("seed")] = 0,
    set_: cli.SetOption = None,
    calibration: cli.CalibrationOption = None,
    model: cli.ModelOption = None,
    tolerance: cli.ToleranceOption = None,
    out: cli.OutOption = Path("outputs"),
    json: cli.JsonOption = False,
) -> None:
    """Simulate the signal of a step or a sine of force: wall, gas, line and gauge; with the gain over frequency."""
    load = _load(step, sine, peak, duration)
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.mechanics.models.choice import model_options
    from pneutouch.workflows.respond import run_respond
    from pneutouch.workflows.responded import responded, write_respond

    with bar("simulating the signal"):
        evaluation = evaluate(design, cli.changes(set_, calibration), **model_options(model, tolerance))
        run = run_respond(evaluation, load, seed)
        record = responded(run)
        folder = write_respond(run, record, out)
    for note in record.notes:
        notify(f"note: {note}")
    cli.print_answer(record, respond_text, folder, json=json)
    if not json:
        report_next("build", design, *set_words(set_, calibration))


def _load(step: str | None, sine: str | None, peak: str | None, duration: float | None) -> "Load":
    """The load that the options describe. Raises InputError if they contradict one another."""
    from pneutouch.errors import InputError
    from pneutouch.workflows.respond import Load, frequency_Hz, load_size

    if sine is None:
        if peak is not None:
            raise InputError("is the peak of a sine", key="peak", remedy="give `sine`, or `step` in its place")
        size, travel = (None, False) if step is None else load_size(step, "step")
        return Load(size, travel, None, duration)
    if step is not None:
        raise InputError("cannot be given with `sine`", key="step", value=step, remedy="give `peak`")
    size, travel = (None, False) if peak is None else load_size(peak, "peak")
    return Load(size, travel, frequency_Hz(sine), duration)


_HEAD = ["kPa", "data", "slow kPa", "greatest kPa", "last kPa", "resonance Hz", "gain there", "3 dB Hz", "5 % Hz"]


def respond_text(record: LoadResponse) -> str:
    """Table of the signal at each driving pressure, by each series of relaxation data."""
    sine = record.sine_Hz
    load = "step" if sine is None else f"sine of {sine:g} Hz"
    sources = list(dict.fromkeys(state.relaxation_source for state in record.states))
    rows = []
    for state in record.states:
        source = state.relaxation_source
        numbers = (
            state.slow_pressure_rise_kPa,
            state.greatest_reading_kPa,
            state.last_reading_kPa,
            state.first_resonance_Hz,
            state.resonance_gain,
            state.bandwidth_3_dB_Hz,
            state.within_5_percent_Hz,
        )
        data = "-" if source is None else chr(ord("A") + sources.index(source))
        ends = [] if sine is None else [_number(state.gain), f"{state.phase_lag_deg:.1f}"]
        rows.append([f"{state.driving_pressure_kPa:g}", data, *map(_number, numbers), *ends])
    head = _HEAD if sine is None else [*_HEAD, "gain", "lag deg"]
    title = f"{record.design}: simulated {load} to {record.peak}, model {record.model}"
    return "\n".join([title, "", table_text(head, rows)])


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
