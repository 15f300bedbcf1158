# SPDX-License-Identifier: BSD-3-Clause
"""The command line that the plotting programs share."""
import argparse
import pathlib
import sys


def draw_folder(draw, description, help):
    """Calls draw(folder) with the folder of the command line and prints the path of the picture."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help=help)
    try:
        print(draw(parser.parse_args().folder))
    except OSError as error:
        sys.exit(f"error: {error.filename}: {error.strerror}")
