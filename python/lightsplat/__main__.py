"""`python -m lightsplat`: the program in place of Python, with the same arguments, streams and exit code."""

import os
import sys

from ._program import program

if __name__ == "__main__":
    path = program()
    os.execv(path, ["lightsplat", *sys.argv[1:]])
