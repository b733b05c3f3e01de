"""Blocks of Python in pages of the documentation, each with the output that may follow it."""

import re

BLOCK = re.compile(r"^```python\n(.*?)^```(?:\n\n```text\n(.*?)^```)?", re.DOTALL | re.MULTILINE)
