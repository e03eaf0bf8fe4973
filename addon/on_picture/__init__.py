# SPDX-License-Identifier: GPL-3.0-or-later
"""Mouse and keys on the picture: where it lies, what a click means."""
