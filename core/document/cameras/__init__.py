# SPDX-License-Identifier: GPL-3.0-or-later
"""One file a camera format: a parsed document in, a Camera out, pixels counted from centres."""
