# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene is the document: a cell into it, out of it, and into files."""
