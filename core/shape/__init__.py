# SPDX-License-Identifier: GPL-3.0-or-later
"""The pure geometry of the solids: curves, rays, features and triangles."""
