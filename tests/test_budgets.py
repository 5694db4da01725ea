"""The package grows no heavier: every count of `tests.budgets` stays within its bound."""

from __future__ import annotations

import pytest

from tests.budgets import BUDGETS, Budget


@pytest.mark.parametrize("budget", BUDGETS, ids=lambda budget: budget.name)
def test_a_count_stays_within_its_bound(budget: Budget) -> None:
    assert budget.count() <= budget.bound


def test_a_bound_that_is_not_the_goal_is_near_the_count() -> None:
    """A bound follows its count down."""
    for budget in BUDGETS:
        assert budget.bound == budget.goal or budget.bound <= 1.05 * budget.count() + 5, budget.name
