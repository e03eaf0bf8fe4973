# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells and cameras on disk: strict readers, and writers that write whole or not at all."""
