"""``python -m toolpost`` is the command ``toolpost``."""

import sys

from ._command import main

sys.exit(main())
