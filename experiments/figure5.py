"""Error curves for several kernels (figure 5).

The same as ``kfmaps reproduce figure5``, with the same options: ``python experiments/figure5.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["reproduce", "figure5", *sys.argv[1:]]))
