"""What an installation takes: ``python benchmarks/install.py [--python PYTHON]``, which makes its own environment.

Prints the seconds of ``pip install`` (CPU, and what the clock shows, with pip's cache as it is), the megabytes of each
package, and the CPU seconds of imports and of ``kfmaps --help`` in processes of their own, the least of five.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
SIZES = """
import importlib.metadata, json
sizes = {}
for one in importlib.metadata.distributions():
    paths = [path.locate() for path in one.files or ()]
    sizes[one.metadata["Name"]] = sum(path.stat().st_size for path in paths if path.is_file())
print(json.dumps(sizes))
"""
STARTS = {
    "python": ["-c", ""],
    "import numpy, scipy.sparse.linalg": ["-c", "import numpy, scipy.sparse.linalg"],
    "import kfmaps": ["-c", "import kfmaps"],
    "kfmaps.match, imported": ["-c", "import kfmaps; kfmaps.match"],
    "kfmaps.match and kfmaps.render": ["-c", "import kfmaps, kfmaps.viz; kfmaps.match"],
    "kfmaps --help": ["-m", "kfmaps", "--help"],
    "kfmaps match --help": ["-m", "kfmaps", "match", "--help"],
}
NAMED = 12  # packages with a row of their own


def spent(words: list[str]) -> tuple[float, float]:
    """CPU seconds and seconds of a process."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, cwd=tempfile.gettempdir(), env=environment())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.perf_counter() - begin


def environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", default=sys.executable, help="the interpreter of the environment")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        python = str(Path(folder) / "bin" / "python")
        spent([options.python, "-m", "venv", folder])
        install = [python, "-m", "pip", "install", "--quiet", "--constraint", str(ROOT / "constraints.txt"), str(ROOT)]
        work, wall = spent(install)
        print(f"pip install: {work:.0f} CPU seconds, {wall:.0f} seconds\n\n| package | MB |\n|---|---|")
        told = subprocess.run([python, "-c", SIZES], check=True, capture_output=True, text=True, env=environment())
        sizes = {
            name: size / 1e6 for name, size in json.loads(told.stdout).items() if name not in ("pip", "setuptools")
        }
        rows = sorted(sizes.items(), key=lambda row: -row[1])
        for name, size in rows[:NAMED]:
            print(f"| {name} | {size:.1f} |")
        print(f"| {len(rows) - NAMED} others | {sum(size for _, size in rows[NAMED:]):.1f} |")
        print(f"| **all** | **{sum(sizes.values()):.0f}** |\n\n| start | CPU seconds |\n|---|---|")
        for name, words in STARTS.items():
            print(f"| {name} | {min(spent([python, *words])[0] for _ in range(5)):.2f} |")


if __name__ == "__main__":
    main()
