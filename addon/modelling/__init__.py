# SPDX-License-Identifier: GPL-3.0-or-later
"""The model's objects, references and looks, edited."""
