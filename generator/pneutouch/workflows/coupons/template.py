"""The results file to fill in: every nominal listed, every reading empty."""

import textwrap
from typing import Any

from pydantic import BaseModel

from pneutouch.parts.coupons import Nominal
from pneutouch.spec.coupon import CouponResults
from pneutouch.spec.fields import table_of
from pneutouch.spec.toml_text import key_text, value_text
from pneutouch.wording import counted
from pneutouch.workflows.coupons.order import CouponItem, CouponOrder

_HEAD = """\
# Results of coupons. Fill in what was measured, leave [] for what was not, then:
#   pneutouch coupons --results FILE    (the path of this file)
# Two readings at least in a list that is filled. Numbers have a point: [27.5, 28.0]
"""


def results_template(order: CouponOrder) -> str:
    """TOML that becomes valid once lab and date are given."""
    blocks = [_HEAD + '# lab = "who measured"\n# date = 2026-11-21']
    filed: set[tuple[str, float]] = set()
    for item in order.items:
        if item.blend is not None:
            key = item.blend.pair, item.blend.fraction
            blocks.append(_mixed(item, first=key not in filed))
            filed.add(key)
            continue
        path = [item.coupon.name, item.about]
        if item.coupon.belongs == "printer":
            path.insert(1, item.printer_name)
        blocks.append(_table(item, ".".join(key_text(step) for step in path)))
    return "\n\n".join(blocks) + "\n"


def _mixed(item: CouponItem, *, first: bool) -> str:
    """A coupon of one fraction: hardness stands in the fraction's own table, dumbbells in one below."""
    assert item.blend is not None
    path = f"mixing.{key_text(item.blend.pair)}"
    lines = [f"[[{path}]]", f"fraction = {value_text(item.blend.fraction)}"] if first else []
    if item.coupon.name != "puck":
        return "\n".join([*lines, *([""] if lines else []), _table(item, f"{path}.{item.coupon.name}")])
    hardness = item.nominals[0]
    return "\n".join([*lines, _empty(hardness, item.copies)])


def _table(item: CouponItem, path: str) -> str:
    nominals = item.nominals
    model = _model(item.coupon.name)
    lines = [f"# {item.coupon.title}: {item.copies} printed", f"[{path}]", *_settings(model)]
    features = list(dict.fromkeys(nominal.feature for nominal in nominals))
    if len(features) < len(nominals):
        lines.append("# came_out = false, in place of readings, where it is missing, broken, blocked or grown together")
        for feature in features:
            lines += _rows(feature, [nominal for nominal in nominals if nominal.feature == feature])
        return "\n".join(lines)
    if not item.coupon.each:
        return "\n".join([*lines, *(_empty(nominal, item.copies) for nominal in nominals)])
    each = table_of(model, item.coupon.each)
    assert each is not None
    for _ in range(item.copies):
        lines += ["", f"[[{path}.{item.coupon.each}]]", *(_reading(each, nominal) for nominal in nominals)]
    return "\n".join(lines)


def _settings(model: type[BaseModel]) -> list[str]:
    """Plain numbers that state how it was measured, at their defaults."""
    lines = []
    for key, info in model.model_fields.items():
        if isinstance(info.default, float):
            lines += [
                *(f"# {line}" for line in textwrap.wrap(info.description or "", 96)),
                f"{key} = {value_text(info.default)}",
            ]
    return lines


def _reading(model: type[BaseModel], nominal: Nominal) -> str:
    default: Any = model.model_fields[nominal.feature].default
    return f"{nominal.feature} = {value_text(default)}" if isinstance(default, float) else _empty(nominal, 1)


def _empty(nominal: Nominal, copies: int) -> str:
    drawn = "" if nominal.value is None else f"nominal {nominal.value:.4g} {nominal.unit}; "
    each = f" on each of {copies}" if copies > 1 else ""
    return f"{nominal.feature} = []  # {drawn}{counted(nominal.readings, 'reading')}{each}"


def _rows(feature: str, nominals: list[Nominal]) -> list[str]:
    rows = [f"  {{ nominal_mm = {value_text(nominal.value)}, measured_mm = [] }}," for nominal in nominals]
    return [f"{key_text(feature)} = [", *rows, "]"]


def _model(coupon: str) -> type[BaseModel]:
    """The model of one table of a coupon in the results file."""
    field = next(name for name, info in CouponResults.model_fields.items() if coupon in (name, info.alias))
    kind: Any = CouponResults.model_fields[field].annotation
    while not (isinstance(kind, type) and issubclass(kind, BaseModel)):
        kind = kind.__args__[-1]
    return kind
