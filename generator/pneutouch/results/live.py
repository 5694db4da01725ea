"""A sensor that is read live: its state, and the record of a command that ended."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveState:
    """State of a device and of its reader at one time."""

    device: str | None
    """Name of the reader that the device was made for, as it says; null: it does not say."""
    link: str
    """Link to the device: waiting, reading, silent, foreign (it sends something else) or unplugged."""
    status: str
    """Status of the last reading, by name."""
    driving_pressures_kPa: tuple[float | None, ...]
    """Pressure of every cell without contact, as the tare and the drift since give it; null before a tare."""
    noise_kPa: float | None
    """Standard deviation of a gauge's reading at the tare; null: unknown."""
    drift_kPa: float | None
    """Drift of the zero since the tare that is followed; null: unknown."""
    rate_Hz: float | None
    """Samples a second, as the device's own clock has them; null before there are any."""
    samples: int
    """Number of samples that came."""
    lost: int
    """Number of samples that were sent and did not arrive."""
    damaged: int
    """Number of lines with a wrong checksum."""
    recording: str | None
    """File that is being recorded; null: none."""
    recorded_s: float
    """Length of the recording."""
    step: str
    """Step of the plan that is to be done now; empty without a plan."""
    step_left_s: float
    """Time that is left of it."""
    said: tuple[str, ...]
    """Last events, the newest last."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveRecord:
    """A live reading that has ended."""

    design: str
    """Name of the design or pad."""
    port: str
    """Name of the port."""
    seconds: float
    """Time from the first sample to the last, by the device's clock."""
    state: LiveState
    """State at the end."""
    greatest_force_N: float | None
    """Greatest force that was read; null: none was."""
    file: str | None
    """File that was recorded; null: none."""
