"""Spectra of the Gaussian kernel (figure 2).

The same as ``kfmaps reproduce figure2``, with the same options: ``python experiments/figure2.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "figure2", *sys.argv[1:]]))
