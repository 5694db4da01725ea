"""A pressure gauge: its range, its resolution, its rate and its output; one TOML a part."""

from typing import Any, Literal

from pydantic import Field, ValidationInfo, field_validator, model_validator

from pneutouch.spec.fields import Table, declaration
from pneutouch.spec.values import Quantity

Reference = Literal["gauge", "absolute"]
"""Reference pressure of a gauge: the air around it, or a vacuum."""

Output = Literal["count", "V", "share of supply", "compensated"]
"""Output of a gauge: a digital count, a voltage, a voltage as share of its supply; or numbers that its driver turns
into a pressure with constants stored in each part."""

Interface = Literal["analog", "I2C", "SPI"]


def _figure(unit: str, low: float, high: float, help: str) -> Any:
    """Declare a sourced number that may be unknown; value and both ends of its range obey the bounds."""
    return Field(default=None, description=help, json_schema_extra={"unit": unit, "low": low, "high": high})


class GaugeRange(Table):
    """[range_kPa]: ends of the measuring range, kPa, gauge or absolute pressure as ``reference`` states."""

    low: float = Field(ge=-1e5, le=1e5, description="Lower end of the range.", json_schema_extra={"unit": "kPa"})
    high: float = Field(ge=-1e5, le=1e5, description="Upper end of the range.", json_schema_extra={"unit": "kPa"})
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")

    @model_validator(mode="after")
    def _rises(self) -> "GaugeRange":
        if self.high <= max(self.low, 0.0):
            raise ValueError(f"low = {self.low:g}, high = {self.high:g}: high must be above low and above 0")
        return self

    @property
    def span(self) -> float:
        """Full scale, kPa."""
        return self.high - self.low


class Transfer(Table):
    """[transfer]: the output at both ends of the range, linear in between; left out if it is compensated."""

    output: Output = Field(description="Output of the gauge.")
    at_low: float | None = Field(default=None, ge=-1e12, le=1e12, description="Output at the low end of the range.")
    at_high: float | None = Field(default=None, ge=-1e12, le=1e12, description="Output at the high end.")
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")

    @model_validator(mode="after")
    def _has_two_ends(self) -> "Transfer":
        ends = (self.at_low, self.at_high)
        if self.output == "compensated":
            if ends != (None, None):
                raise ValueError("at_low and at_high must be left out where output is compensated")
        elif None in ends or self.at_low == self.at_high:
            raise ValueError(f"at_low and at_high must be two different outputs, in {self.output}")
        return self


class Gauge(Table):
    """A pressure gauge as it is sold. A figure that is left out is unknown; ``unknown`` names the figures that were
    searched for."""

    title: str = Field(min_length=1, max_length=80, description="Name of the gauge.")
    maker: str = Field(min_length=1, max_length=40, description="Name of the maker.")
    order_code: str = Field(min_length=1, max_length=40, description="Part number of the maker.")
    reference: Reference = Field(description="gauge: against the air around it; absolute: against a vacuum.")
    interfaces: list[Interface] = Field(min_length=1, description="How it is read.")
    i2c_address: int | None = Field(default=None, ge=0x08, le=0x77, description="Address on the I2C bus.")
    port: str = Field(min_length=1, description="How the tube meets it.")
    range_kPa: GaugeRange = Field(description="The pressures that are read, in the gauge's reference.")
    transfer: Transfer = Field(description="The output at both ends of the range.")
    resolution_kPa: Quantity | None = _figure(
        "kPa", 0, 1e3, "Smallest step of a reading; left out of an analog gauge: the recorder's."
    )
    noise_kPa: Quantity | None = _figure("kPa", 0, 1e3, "Standard deviation of one reading, at the rate stated.")
    rate_Hz: Quantity | None = _figure("Hz", 1e-2, 1e6, "Readings a second.")
    bandwidth_Hz: Quantity | None = _figure("Hz", 1e-2, 1e6, "Where an analog output has fallen by 3 dB.")
    error_kPa: Quantity | None = _figure(
        "kPa", 0, 1e4, "Greatest error over range and temperature: the total error band, to either side."
    )
    inner_volume_mL: Quantity | None = _figure("mL", 0, 1e2, "Gas in port and chamber: a part of the dead volume.")
    overload_kPa: Quantity | None = _figure("kPa", 0, 1e5, "Greatest pressure that leaves it as it was.")
    supply_V: Quantity | None = _figure("V", 0.5, 60, "Supply voltage.")  # noqa: N815
    temperature_C: Quantity | None = _figure("°C", -100, 300, "Temperatures at which it may be used.")
    unknown: dict[str, str] = Field(default_factory=dict, description="For figures left out: the sources searched.")

    @field_validator(
        "resolution_kPa",
        "noise_kPa",
        "rate_Hz",
        "bandwidth_Hz",
        "error_kPa",
        "inner_volume_mL",
        "overload_kPa",
        "supply_V",
        "temperature_C",
    )
    @classmethod
    def _within_bounds(cls, given: Quantity | None, info: ValidationInfo) -> Quantity | None:
        declared = declaration(cls, str(info.field_name))
        for key in ("value", "low", "high") if given is not None else ():
            number = getattr(given, key)
            if number is not None and not (declared.low or 0.0) <= number <= (declared.high or 0.0):
                raise ValueError(f"{key} = {number:g}: must be {declared.right}")
        return given

    @model_validator(mode="after")
    def _unknown_are_left_out(self) -> "Gauge":
        for key in self.unknown:
            if key not in FIGURES:
                raise ValueError(f"unknown.{key}: is no figure of a gauge; must be one of {', '.join(FIGURES)}")
            if getattr(self, key) is not None:
                raise ValueError(f"unknown.{key}: is given as {key} too; give one of both")
        return self

    @model_validator(mode="after")
    def _absolute_above_vacuum(self) -> "Gauge":
        if self.reference == "absolute" and self.range_kPa.low < 0:
            raise ValueError(f"range_kPa.low = {self.range_kPa.low:g}: must not be below 0 of an absolute gauge")
        return self

    @property
    def is_absolute(self) -> bool:
        """True if the gauge reads absolute pressure: ambient plus gauge pressure."""
        return self.reference == "absolute"

    def gauge_pressures_kPa(self, ambient_kPa: float) -> tuple[float, float]:
        """Least and greatest gauge pressure, kPa, that it reads at an ambient pressure: for an absolute gauge its range
        less the ambient pressure, so that the greatest is negative if the range ends below the ambient pressure."""
        shift_kPa = ambient_kPa if self.is_absolute else 0.0
        return self.range_kPa.low - shift_kPa, self.range_kPa.high - shift_kPa

    def pressure_kPa(self, output: float) -> float:
        """Pressure, kPa, in the gauge's reference for an output. Raises ValueError if the output is compensated."""
        low, high = self._ends()
        return self.range_kPa.low + (output - low) / (high - low) * self.range_kPa.span

    def output(self, pressure_kPa: float) -> float:
        """Output at a pressure, kPa, in the gauge's reference. Raises ValueError if the output is compensated."""
        low, high = self._ends()
        return low + (pressure_kPa - self.range_kPa.low) / self.range_kPa.span * (high - low)

    def _ends(self) -> tuple[float, float]:
        low, high = self.transfer.at_low, self.transfer.at_high
        if low is None or high is None:
            raise ValueError(
                f"the output of the {self.title} is turned into a pressure by constants stored in each part"
            )
        return low, high


FIGURES = tuple(key for key, info in Gauge.model_fields.items() if info.annotation == Quantity | None)
"""Keys of the figures that may be unknown."""
