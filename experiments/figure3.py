"""Nyström error against rank (figure 3).

The same as ``kfmaps reproduce figure3``, with the same options: ``python experiments/figure3.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "figure3", *sys.argv[1:]]))
