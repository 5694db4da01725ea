"""Print files of any design that the ranges allow: built sound, or refused with the reason; nothing crashes."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import load_scene
from pneutouch.parts import assemble
from pneutouch.spec.read import parse_changes
from tests.catalogue.store import printed_combinations
from tests.stability.prints import LIBRARY, RESINS, outcome, strict_warnings

PARTS = printed_combinations(LIBRARY)
SIZES = {6.0: 1.0, 9.25: 1.5, 15.0: 2.0}
"""Inner radius and wall of three domes, mm."""

MELTING = ("connector.material=ABS", "print.connector_profile=abs-filament")
"""What a connector with heat-set inserts is made of; one printed together with its membrane has none."""

ROOMLESS = {"too small for", "too large for"}
PROFILES = {"objet260-connex": "VeroClear", "j735": "VeroClear", "abs-filament": "ABS"}


def chosen_parts(port, seat, mount):
    return [f"connector.port={port}", f"connector.seat={seat}", f"connector.mount={mount}"]


def random_design(rng):
    """Overrides drawn from the allowed ranges, small and large domes alike often."""
    radius = float(np.exp(rng.uniform(np.log(1.0), np.log(100.0))))
    wall = float(np.clip(radius * np.exp(rng.uniform(np.log(0.02), np.log(0.9))), 0.05, 50))
    profile, connector = rng.choice(["objet260-connex", "j735"]), str(rng.choice(sorted(PROFILES)))
    resin, (port, seat, mount) = str(rng.choice(RESINS)), PARTS[rng.integers(len(PARTS))]
    return [
        f"membrane.inner_radius_mm={radius!r}",
        f"membrane.wall_thickness_mm={wall!r}",
        f"membrane.material={resin}",
        f"print.profile={profile}",
        f"print.connector_profile={connector}",
        f"connector.material={PROFILES[connector]}",
        *chosen_parts(port, seat, mount),
    ]


def judge(chosen):
    """What became of a design; a refusal names the file, the key and the value."""
    fate, why = outcome("stiff-dome", chosen)
    if fate == "refused":
        assert "stiff-dome.toml: " in why
        assert " = " in why or "must be" in why, why
    elif fate == "broken":
        assert all(finding.message and finding.fix and finding.source for finding in why)
    return fate


@pytest.mark.parametrize("seed", [pytest.param(k, marks=pytest.mark.slow if k % 4 else ()) for k in range(20)])
def test_a_random_design_is_built_or_refused(seed):
    judge(random_design(np.random.default_rng(7000 + seed)))


@pytest.mark.slow
def test_a_thousand_random_designs_are_built_or_refused(capsys):
    fates = [judge(random_design(np.random.default_rng(seed))) for seed in range(1000)]
    counts = {fate: fates.count(fate) for fate in ("built", "broken", "refused")}
    with capsys.disabled():
        print(f"\n1,000 random designs: {counts}")  # noqa: T201
    assert counts["built"] > 100


@pytest.mark.slow
@pytest.mark.parametrize("radius", SIZES)
def test_every_combination_of_parts_is_ready_to_print_or_names_the_reason(radius, capsys):
    counts = {"built": 0, "broken": 0, "refused": 0}
    reasons = set()
    for port, seat, mount in PARTS:
        chosen = [
            f"membrane.inner_radius_mm={radius}",
            f"membrane.wall_thickness_mm={SIZES[radius]}",
            *chosen_parts(port, seat, mount),
            *(MELTING if "insert" in f"{seat} {mount}" and seat != "one-piece" else ()),
        ]
        fate, why = outcome("stiff-dome", chosen)
        counts[fate] += 1
        if fate == "refused":
            assert any(words in why for words in ROOMLESS), why
            reasons.add(why.partition(": membrane")[2][:120])
            continue
        if fate == "broken":
            reasons |= {f"{f.rule}: {f.message}" for f in why if f.severity == "error"}
        assembly = assemble(load_scene("stiff-dome", parse_changes(chosen), LIBRARY))
        assert strict_warnings("x", tuple(b.moved(assembly.print_offset) for b in assembly.bodies)) == 0
    with capsys.disabled():
        print(f"\nR0 {radius:g} mm, {len(PARTS)} combinations: {counts}", *sorted(reasons), sep="\n  ")  # noqa: T201
    assert counts["built"] > 0.7 * len(PARTS)
