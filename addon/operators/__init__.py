# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs, one a file."""


def classes():
    """Every operator, in the order of the work."""
    from .add_box import AddBox
    from .add_cylinder import AddCylinder
    from .calibrate import Calibrate
    from .export_gltf import ExportCell
    from .look_through import LookThrough
    from .open_cell import OpenCell
    from .open_picture import OpenPicture
    from .save_cell import SaveCell
    from .show_picture import ShowPicture
    from .solve_again import SolveAgain

    return (
        OpenCell,
        OpenPicture,
        LookThrough,
        ShowPicture,
        Calibrate,
        AddBox,
        AddCylinder,
        SolveAgain,
        ExportCell,
        SaveCell,
    )
