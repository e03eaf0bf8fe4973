# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels on known planes and lines to points, boxes and cylinders, with their errors."""
