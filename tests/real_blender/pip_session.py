# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in the Python of a pip bpy: the zip is installed as a user does it, then steps.py runs.

python pip_session.py ZIP STEPS -- JOB
"""

import runpy
import sys

import bpy

extension_zip, steps = sys.argv[1:3]
done = bpy.ops.extensions.package_install_files(
    filepath=extension_zip, repo="user_default", enable_on_install=True
)
if done != {"FINISHED"}:
    sys.exit(f"{bpy.app.version_string} does not install {extension_zip}: {done}")
runpy.run_path(steps, run_name="__main__")
