"""A scripted person uses the annotator in a real window: from a bare picture to a saved, fitted, exported stride.

Usage:

    cargo build --release -p annotator --features inspection
    python3 tests/window/person.py [--program PATH] [--out FOLDER] [--plates PATH] [--only PLATE] [--required]

Needs Xvfb, xdotool, ImageMagick's `import`, and `pip install msgpack`. Where one is missing it says `skipped: ...` and
ends with 0, or with 1 when `--required` is given. Everything is done by pointer and keys on a screen of its own
(`desktop.py`); the places to click are found by name. Two plates are worked on, each copied alone into a temporary
folder, so that nothing is known of it but the picture: the drawn specimen of a gallop, and the card of Sallie Gardner
where it is on this machine. What the person sees in the photographs is in `plates/specimens/annotations` (the truth
of the drawing) and in `annotations` (placed by people).

A screenshot is taken after each step into FOLDER. Prints each step, what was read off the window, and measured times.
The exit code is 1 when anything is not as it should be.
"""

import argparse
import math
import shutil
import sys
import tempfile
from pathlib import Path

import desktop
import story

ROOT = Path(__file__).resolve().parents[2]


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description="A scripted person uses the annotator in a real window.")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/annotator")
    parser.add_argument("--out", type=Path, default=ROOT / "target/person")
    parser.add_argument("--plates", type=Path, default=ROOT.parent / "shared/plates")
    parser.add_argument("--only", choices=["specimen-gallop", "sallie-gardner-1878"])
    parser.add_argument("--required", action="store_true", help="fail where something that is needed is missing")
    return parser.parse_args()


def main():
    """Both plates."""
