"""``python -m kfmaps``: the command, where its script is not on the path."""

import sys

from kfmaps.app.cli import main

sys.exit(main())
