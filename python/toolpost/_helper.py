"""A helper of the studio: ``python -I -S _helper.py`` and the file of the compiled module.

It does not import the package, which would import NumPy first: a helper shall begin at once.
"""

import sys
from importlib.machinery import ExtensionFileLoader
from importlib.util import module_from_spec, spec_from_loader


def main() -> int:
    """Do one step of the work of the studio that has started this."""
    loader = ExtensionFileLoader("_native", sys.argv[1])
    spec = spec_from_loader("_native", loader)
    if spec is None:
        return 1
    native = module_from_spec(spec)
    loader.exec_module(native)
    code: int = native.run_command(["toolpost", "helper"], [])
    return code


if __name__ == "__main__":
    sys.exit(main())
