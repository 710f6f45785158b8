"""The command ``toolpost``."""

import os
import signal
import sys

from . import _native


def main() -> int:
    """Obey the command line and answer its exit code."""
    # What runs is no Python, which would only look for the interrupt when it is over.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.run_command(["toolpost", *sys.argv[1:]], helper())


def helper() -> list[str]:
    """Give the words by which the studio starts its helpers; none where no interpreter is known."""
    script = os.path.join(os.path.dirname(__file__), "_helper.py")
    return [sys.executable, "-I", "-S", script, _native.__file__] if sys.executable else []
