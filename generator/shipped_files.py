"""Build hook: wheel and source archive hold the shipped designs, profiles and examples that pyproject.toml lists.

Other files of those folders, such as a user's private design, are left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_DATA = "pneutouch/data"
"""Folder of the wheel that takes them."""


class ShippedFiles(BuildHookInterface[Any]):
    """Adds every file of [tool.pneutouch] shipped. Raises FileNotFoundError where one is missing."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the files to the archive; an editable installation reads them where they lie."""
        if version == "editable":
            return
        for name in self.metadata.config["tool"]["pneutouch"]["shipped"]:
            path = Path(self.root) / name
            if not path.is_file():
                raise FileNotFoundError(f"{path}: is listed as shipped in pyproject.toml and is not there")
            build_data["force_include"][str(path)] = f"{_DATA}/{name}" if self.target_name == "wheel" else name
