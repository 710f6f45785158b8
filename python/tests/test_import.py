"""What it takes to import the package."""

from __future__ import annotations

import subprocess
import sys

WATCH = """
import sys, time
begin = time.process_time()
import toolpost
print(time.process_time() - begin, "numpy" in sys.modules)
"""


def test_the_import_takes_less_than_50_ms_and_no_numpy():
    seconds = []
    for _ in range(10):
        done = subprocess.run([sys.executable, "-c", WATCH], capture_output=True, check=True)
        took, numpy = done.stdout.split()
        seconds.append(float(took))
        assert numpy == b"False"
    # Time of the processor, and the best: what else runs here is not the package's doing.
    assert min(seconds) < 0.05
