"""The command line: ``fretwork``, or ``python -m fretwork``."""

import signal
import sys

from . import _fretwork


def main() -> int:
    """Calls the command line with the arguments of this process; returns the exit code."""
    # The command line handles Ctrl-C itself: Python is not to answer it a second time.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _fretwork.command_line(["fretwork", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
