"""Runs a test module, or a script with its arguments, or says what is missing and leaves with 77, which ctest takes for
skipped: run.py PACKAGE,... {MODULE | SCRIPT.py ARGUMENT...}"""

import importlib
import os
import runpy
import sys
import unittest

for package in sys.argv[1].split(","):
    try:
        importlib.import_module(package)
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(77)
if sys.argv[2].endswith(".py"):
    sys.argv = sys.argv[2:]
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))  # as Python does
    runpy.run_path(sys.argv[0], run_name="__main__")
else:
    unittest.main(module=sys.argv[2], argv=sys.argv[:1], verbosity=2)
