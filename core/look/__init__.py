# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects look like in the picture: their colours, and textures of their faces."""
