# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs, one a file."""


def classes():
    """Every operator, in the order of the work."""
    from .add_box import AddBox
    from .add_cylinder import AddCylinder
    from .add_pictures import AddPictures
    from .add_point import AddPoint
    from .add_sighting import AddSighting
    from .calibrate import Calibrate
    from .cancel_work import CancelWork
    from .clear_window import ClearWindow
    from .drag_window import DragWindow
    from .drop_picture import DropPicture
    from .export_gltf import ExportCell
    from .find_all import FindAll
    from .look_through import LookThrough
    from .open_cell import OpenCell
    from .open_picture import OpenPicture
    from .open_sample import OpenSample
    from .paste_sightings import PasteSightings
    from .read_sightings import ReadSightings
    from .remove_sighting import RemoveSighting
    from .save_cell import SaveCell
    from .show_picture import ShowPicture
    from .solve_again import SolveAgain

    return (
        OpenSample,
        OpenCell,
        OpenPicture,
        DropPicture,
        LookThrough,
        ShowPicture,
        AddPictures,
        PasteSightings,
        ReadSightings,
        AddSighting,
        AddPoint,
        RemoveSighting,
        DragWindow,
        ClearWindow,
        FindAll,
        Calibrate,
        CancelWork,
        AddBox,
        AddCylinder,
        SolveAgain,
        ExportCell,
        SaveCell,
    )
