"""The command ``toolpost``."""

import signal
import sys

from ._native import run_command


def main() -> int:
    """Obey the command line and answer its exit code."""
    # What runs is no Python, which would only look for the interrupt when it is over.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run_command(["toolpost", *sys.argv[1:]])
