"""A number with its source: nothing empirical enters the program without one."""

from __future__ import annotations

from pydantic import Field, model_validator

from pneutouch.spec.fields import Table


class Quantity(Table):
    """A sourced number: a value, or the range a source gives, or both; ``spread`` is one standard deviation."""

    value: float | None = Field(
        default=None, description="The number, in the unit of its key; may be left out if there is a range."
    )
    low: float | None = Field(default=None, description="Lower end of the range.")
    high: float | None = Field(default=None, description="Upper end of the range.")
    spread: float | None = Field(default=None, ge=0, description="One standard deviation.")
    source: str = Field(min_length=8, description="Table, page or DOI; how far it was verified.")

    @model_validator(mode="after")
    def _is_not_empty(self) -> Quantity:
        if self.value is None and (self.low is None or self.high is None):
            raise ValueError("give value, or low and high")
        if self.low is not None and self.high is not None and self.low > self.high:
            raise ValueError("low must not exceed high")
        return self

    @property
    def nominal(self) -> float:
        """The value, else the middle of the range."""
        if self.value is not None:
            return self.value
        assert self.low is not None and self.high is not None
        return 0.5 * (self.low + self.high)

    @property
    def least(self) -> float:
        """The lower end of the range where there is one, else the value."""
        return self.low if self.low is not None else self.nominal

    @property
    def most(self) -> float:
        """The upper end of the range where there is one, else the value."""
        return self.high if self.high is not None else self.nominal

    def text(self, digits: int = 4) -> str:
        """The number as a datasheet prints it: ``0.17``, ``1.3 to 1.8``, ``27.6 +- 1.0``."""
        if self.value is not None and self.spread is not None:
            return f"{self.value:.{digits}g} ± {self.spread:.{digits}g}"
        if self.value is not None:
            return f"{self.value:.{digits}g}"
        return f"{self.low:.{digits}g} to {self.high:.{digits}g}"
