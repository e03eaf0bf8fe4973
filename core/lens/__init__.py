# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a chessboard or ChArUco board in, a lens's intrinsics with their errors out."""
