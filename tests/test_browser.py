"""Where there is no browser the tests of pages are left out and say so, unless one is required."""

from __future__ import annotations

import pytest

from tests.browser import VARIABLE, WHY_NOT, leave_out_or_fail


def test_without_a_browser_a_test_is_left_out_with_the_reason():
    with pytest.raises(pytest.skip.Exception, match=WHY_NOT):
        leave_out_or_fail(None, {})


def test_where_a_browser_is_required_a_test_without_one_fails():
    with pytest.raises(pytest.fail.Exception, match=f"{VARIABLE}=required, but there is none of chromium"):
        leave_out_or_fail(None, {VARIABLE: "required"})


def test_with_a_browser_a_test_runs():
    leave_out_or_fail("/usr/bin/chromium", {VARIABLE: "required"})


def test_continuous_integration_sets_what_requires_a_browser(root):
    assert f"export {VARIABLE}=required" in (root / ".ci" / "run").read_text()
