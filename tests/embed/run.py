"""Runs a test module, or says what it lacks and leaves with 77, which ctest takes for skipped: run.py MODULE [PACKAGE...]"""

import importlib
import sys
import unittest

for package in ["numpy"] + sys.argv[2:]:
    try:
        importlib.import_module(package)
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(77)
unittest.main(module=sys.argv[1], argv=sys.argv[:1], verbosity=2)
