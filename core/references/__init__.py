# SPDX-License-Identifier: GPL-3.0-or-later
"""Where reference planes and lines come from, and working out their place and their error."""
