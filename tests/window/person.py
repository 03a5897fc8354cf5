"""A scripted person uses the annotator in a real window: from a bare picture to a saved, fitted, exported stride.

Usage:

    cargo build --release -p annotator --features inspection
    python3 tests/window/person.py [--program PATH] [--out FOLDER] [--card PATH] [--only PLATE] [--required]

Needs Xvfb, xdotool, ImageMagick's `import`, and `pip install msgpack`. Where one is missing it says `skipped: ...` and
ends with 0, or with 1 when `--required` is given. Everything is done by pointer and keys on a screen of its own
(`desktop.py`); where to click is found by name. What is done is in `making.py` and `keeping.py`.

Two plates are worked on, each copied alone into a temporary folder, so that nothing is known of it but the picture:
the drawn specimen of a gallop, and the card of Sallie Gardner where it is on this machine (`--card`). What the person
sees in the photographs is in `plates/specimens/annotations` (the truth of the drawing) and in `annotations` (placed by
hand before).

A screenshot is taken after each step into FOLDER. Prints each step, what was read off the window, and measured times.
The exit code is 1 when anything is not as it should be, 2 for wrong usage.
"""

import argparse
import shutil
import sys
import tempfile
import traceback
from pathlib import Path

import desktop
import keeping

ROOT = Path(__file__).resolve().parents[2]
SPECIMEN, CARD = "specimen-gallop", "sallie-gardner-1878"
# What is known of each plate: the specimen's from its truth, the card's as it is printed on it.
KNOWN = {
    SPECIMEN: {
        "title": "Specimen: gallop",
        "numbers": [
            ("Known length", "0.6858"),
            ("= Marks stand", "on a wall: distances"),
            ("Camera to track", "12"),
            ("Camera to wall", "14.4"),
            ("Camera spacing", "0.4515"),
            ("First axis mark", "4"),
            ("Interval", "0.03901"),
        ],
        "px_per_m": 66.07,
        "tracked_px": 5.0,
    },
    CARD: {
        "title": "The Horse in Motion. Sallie Gardner",
        "numbers": [
            ("Known length", "0.6858"),
            ("= Marks stand", "on a wall: distances"),
            ("Camera to track", "12"),
            ("Camera to wall", "13.5"),
            ("Camera spacing", "0.6858"),
            ("Interval", "1/25"),
            ("= Last panel of the stride", "panel 11"),
        ],
        "px_per_m": None,
        "tracked_px": 30.0,
    },
}


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description="A scripted person uses the annotator in a real window.")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/annotator")
    parser.add_argument("--out", type=Path, default=ROOT / "target/person")
    parser.add_argument("--card", type=Path, default=ROOT.parent / "shared/plates/sallie-gardner-1878/plate.jpg")
    parser.add_argument("--only", choices=[SPECIMEN, CARD])
    parser.add_argument("--required", action="store_true", help="fail where something that is needed is missing")
    return parser.parse_args()


def story(person, plate, whole):
    """The steps in their order; those of `whole` only for the specimen, whose every point is known."""
    known = KNOWN[plate]
    yield from [] if not whole else [person.first_start]
    yield person.open_picture
    yield person.split
    yield "name the plate", lambda: person.name_plate("gallop", known["title"])
    yield "calibrate", lambda: person.calibrate(known["numbers"])
    yield person.pose_by_hand
    yield "scale", lambda: person.scale(known["px_per_m"])
    yield person.correct
    yield person.drag_skeleton
    yield "propose", lambda: person.propose(known["tracked_px"])
    yield person.look_round
    yield person.contacts
    if whole:
        yield "fit", lambda: person.fit(whole)
        yield person.play
    yield person.killed_and_recovered
    yield person.export
    if whole:
        yield person.command_list
        yield person.keys
        yield person.browse
        yield person.measure
    yield person.leave


def use(screen, program, out, plate, picture, truth, whole):
    """One plate from the bare picture on; what was not as it should be."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(picture, Path(folder) / f"{plate}.jpg")
        shutil.copy(ROOT / "plates/catalogue.toml", folder)
        person = keeping.Person(screen, program, Path(folder), out, plate, desktop.read_json(truth))
        try:
            for step in story(person, plate, whole):
                name, act = step if isinstance(step, tuple) else (step.__name__.replace("_", " "), step)
                print(f"{plate}: {name}", flush=True)
                act()
        except (desktop.Failure, OSError, ValueError, KeyError, StopIteration) as trouble:
            traceback.print_exc(limit=-3)
            screen.photograph(out / f"{plate}-failed.png")
            person.failures.append(f"{name}: {trouble}")
        finally:
            if person.program:
                person.program.stop()
        return [f"{plate}: {what}" for what in person.failures]


def main():
    """Both plates, as far as they are there."""
    given = arguments()
    missing = desktop.missing()
    if not given.program.exists():
        missing.append(f"{given.program} (built with the feature `inspection`)")
    if missing:
        print(f"skipped: this needs {', '.join(missing)}")
        return int(given.required)
    given.out.mkdir(parents=True, exist_ok=True)
    specimens = ROOT / "plates/specimens"
    truth = specimens / "annotations" / f"{SPECIMEN}.json"
    plates = [(SPECIMEN, specimens / f"{SPECIMEN}.jpg", truth, truth)]
    plates.append((CARD, given.card, ROOT / "annotations" / f"{CARD}.json", None))
    failures, screen = [], desktop.Screen()
    try:
        for plate, picture, truth, whole in plates:
            if given.only not in (None, plate):
                continue
            if not picture.exists():
                print(f"skipped: {plate}: {picture} is not on this machine")
                continue
            failures += use(screen, given.program.resolve(), given.out, plate, picture, truth, whole)
    finally:
        screen.close()
    print(f"{len(failures)} things are not as they should be" if failures else "everything is as it should be")
    for failure in failures:
        print(f"  {failure}")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(main())
