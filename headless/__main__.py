# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m monocell.headless VERB ...`: the command line without an installed script."""

import sys

from .cli import main

sys.exit(main())
