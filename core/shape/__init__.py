# SPDX-License-Identifier: GPL-3.0-or-later
"""Pure geometry of the solids: their edges and outlines, rays against them, faces and axes."""
