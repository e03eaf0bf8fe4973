# SPDX-License-Identifier: GPL-3.0-or-later
"""From picks to solids near the answer: a start for every kind and every way of picking it."""
