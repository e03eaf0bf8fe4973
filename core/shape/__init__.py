# SPDX-License-Identifier: GPL-3.0-or-later
"""Pure geometry of the solids: faces, edges and outlines, rays that hit them, triangles."""
