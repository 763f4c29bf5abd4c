"""Prints a value of a summary.json by its path, `nan` where there is none.

Usage: python3 docs/summary_value.py FILE KEY...
"""

import json
import sys

try:
    with open(sys.argv[1]) as file:
        value = json.load(file)
    for key in sys.argv[2:]:
        value = value[key]
except (OSError, KeyError, TypeError, ValueError):
    value = None
print("nan" if value is None else value)
