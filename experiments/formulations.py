"""The kernel in every formulation of functional maps.

The same as ``kfmaps reproduce formulations``, with the same options: ``python experiments/formulations.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "formulations", *sys.argv[1:]]))
