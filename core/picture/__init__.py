# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels in and out: files, linear light, lens-free pictures, wire-frames drawn over them."""
