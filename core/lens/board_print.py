# SPDX-License-Identifier: GPL-3.0-or-later
"""A board in, a page to print out, in exact millimetres: SVG, PDF or PNG."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..atomic import atomic_path
from ..errors import DocumentError
from .board import Board
from .drawing import black_rectangles, board_picture

MARGIN_MM = 10.0
POINTS_PER_MM = 72 / 25.4
PNG_DOTS_PER_INCH = 300.0
ENDINGS = (".pdf", ".svg", ".png")


def write_board(board: Board, path: str | Path) -> tuple[float, float]:
    """Write the board by the path's ending; the page's width and height in mm are returned.

    Raises DocumentError for another ending.
    """
    file = Path(path)
    writer = {".svg": _svg, ".pdf": _pdf, ".png": _png}.get(file.suffix.lower())
    if writer is None:
        raise DocumentError(f"{file}: a board to print ends in {', '.join(ENDINGS)}")
    data = writer(board)
    with atomic_path(file) as temporary:
        temporary.write_bytes(data)
    return page_millimetres(board)


def page_millimetres(board: Board) -> tuple[float, float]:
    """Width and height of the page: the board and a white margin of 10 mm or a square."""
    side = 1e3 * board.square
    wide, high = (n * side + 2 * _margin(board) for n in board.squares)
    return wide, high


def _margin(board: Board) -> float:
    """A white rim of a square: detectors need it."""
    return max(MARGIN_MM, 1e3 * board.square)


def _rectangles(board: Board) -> Array:
    """Black rectangles (N, 4) on the page in mm."""
    placed = 1e3 * board.square * black_rectangles(board)
    placed[:, :2] += _margin(board)
    return placed


def _svg(board: Board) -> bytes:
    wide, high = page_millimetres(board)
    drawn = "".join(
        f'<rect x="{x:.6g}" y="{y:.6g}" width="{w:.6g}" height="{h:.6g}"/>\n'
        for x, y, w, h in _rectangles(board)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide:.6g}mm" height="{high:.6g}mm" '
        f'viewBox="0 0 {wide:.6g} {high:.6g}" shape-rendering="crispEdges">\n'
        f"<title>{board}, squares of {1e3 * board.square:.6g} mm</title>\n"
        f'<rect width="{wide:.6g}" height="{high:.6g}" fill="white"/>\n{drawn}</svg>\n'
    ).encode()


def _pdf(board: Board) -> bytes:
    """One page of filled rectangles (ISO 32000: y up, 72 points an inch)."""
    wide, high = (POINTS_PER_MM * v for v in page_millimetres(board))
    rectangles = POINTS_PER_MM * _rectangles(board)
    drawn = "".join(f"{x:.5f} {high - y - h:.5f} {w:.5f} {h:.5f} re\n" for x, y, w, h in rectangles)
    content = f"0 g\n{drawn}f\n".encode()
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {wide:.5f} {high:.5f}] "
        "/Resources << >> /Contents 4 0 R >>".encode(),
        b"<< /Length %d >>\nstream\n%sendstream" % (len(content), content),
    ]
    written, places = b"%PDF-1.4\n", []
    for number, body in enumerate(objects, 1):
        places.append(len(written))
        written += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    return written + (
        b"xref\n0 %d\n0000000000 65535 f \n%strailer\n<< /Size %d /Root 1 0 R >>\n"
        b"startxref\n%d\n%%%%EOF\n" % (len(objects) + 1, table, len(objects) + 1, len(written))
    )


def _png(board: Board) -> bytes:
    """At about 300 dots an inch, so chosen that a square is a whole number of dots."""
    dots = max(1, round(1e3 * board.square / 25.4 * PNG_DOTS_PER_INCH))
    picture = board_picture(board, dots, _margin(board) / (1e3 * board.square))
    return _with_size(picture, dots / board.square)


def _with_size(picture: NDArray[np.uint8], dots_per_metre: float) -> bytes:
    """A PNG that states how large it is to be printed (its pHYs chunk)."""
    _, encoded = cv2.imencode(".png", picture)
    data = encoded.tobytes()
    dots = round(dots_per_metre)
    body = b"pHYs" + struct.pack(">IIB", dots, dots, 1)
    chunk = struct.pack(">I", 9) + body + struct.pack(">I", zlib.crc32(body))
    # after the signature and the header chunk, which are always so long
    return data[:33] + chunk + data[33:]
