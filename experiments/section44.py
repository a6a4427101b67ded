"""Rank and condition number against the number of descriptors (section 4.4).

The same as ``kfmaps reproduce section44``, with the same options: ``python experiments/section44.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "section44", *sys.argv[1:]]))
