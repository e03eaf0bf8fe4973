# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough model and its picture in, the model aligned on the picture's edges out."""
