# SPDX-License-Identifier: GPL-3.0-or-later
"""What alignment and proposals offer, taken or left."""
