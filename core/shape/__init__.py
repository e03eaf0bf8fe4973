# SPDX-License-Identifier: GPL-3.0-or-later
"""Pure geometry of the solids: what they are made of, and how that changes with their sizes."""
