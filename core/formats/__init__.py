# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell as the text that robot programs read: URDF, SDF, MJCF, a MoveIt planning scene."""
