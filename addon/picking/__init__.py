# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects picked on the picture, by plans that are data."""
