"""One pair with 2, 4, 10 and 100 descriptors (figure 4).

The same as ``kfmaps reproduce figure4``, with the same options: ``python experiments/figure4.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "figure4", *sys.argv[1:]]))
