"""Ours against NO17 and OBCS12 (figure 6).

The same as ``kfmaps reproduce figure6``, with the same options: ``python experiments/figure6.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "figure6", *sys.argv[1:]]))
