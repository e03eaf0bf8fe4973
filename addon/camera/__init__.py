# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera's step: sightings, their places, the calibration, the lens."""
