# SPDX-License-Identifier: GPL-3.0-or-later
"""The version of monocell, the same in pyproject.toml and blender_manifest.toml (tested)."""

VERSION = "0.1.0"
