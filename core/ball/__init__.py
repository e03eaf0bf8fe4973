# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls in pictures: round things voted for, elected, and measured on their limb."""
