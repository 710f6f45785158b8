"""``python -m toolpost`` is the command ``toolpost``."""

import sys

from ._command import main

if __name__ == "__main__":
    sys.exit(main())
