"""Residuals of conjugate gradients, and the time of an application (figure 7).

The same as ``kfmaps reproduce figure7``, with the same options: ``python experiments/figure7.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "figure7", *sys.argv[1:]]))
