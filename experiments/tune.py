"""Grid search over settings on training pairs (section 7.2).

The same as ``kfmaps tune``, with the same options: ``python experiments/tune.py --data DIR``.
"""

import sys

from kfmaps.cli.main import main

if __name__ == "__main__":
    sys.exit(main(["tune", *sys.argv[1:]]))
