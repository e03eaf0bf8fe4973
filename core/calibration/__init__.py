# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera from its sightings: balls at known places in, a pose with its error out."""
