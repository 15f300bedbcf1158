# SPDX-License-Identifier: BSD-3-Clause
"""The program: `plica` after an installation, or `python -m plica`."""

import signal
import sys

from . import _plica


def main() -> int:
    """Runs the program with the words of the command line. Its exit status."""
    for number in (signal.SIGINT, signal.SIGPIPE):  # Python has taken them
        signal.signal(number, signal.SIG_DFL)
    return _plica.program(["plica", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
