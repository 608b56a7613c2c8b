"""The command: ``python -m holonom`` does what ``holonom`` does."""

import sys

from . import _engine

sys.exit(_engine.command(["holonom", *sys.argv[1:]]))
