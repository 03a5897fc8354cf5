"""Reads exported annotations with the tools they are for, and compares what those tools see.

Usage:

    for format in deeplabcut coco labelme; do
        muybridge annotations export PLATE --format $format --images --out FOLDER/$format
    done
    muybridge annotations export PLATE --format csv --out FOLDER/csv
    python3 tests/readers/annotations.py FOLDER plates/PLATE.json

    pip install pandas sleap-io labelme movement    (any of them may be missing)

The truth is the plain table, in pixels of the plate, put into each panel's picture by a transform that is worked out
here anew from the corners in the manifest. A reader that is not installed is skipped and said to be.
The exit code is 0 when every installed reader agrees, 1 when one does not, 2 for wrong usage.
"""

import csv
import importlib
import importlib.util
import json
import math
import os
import sys
from pathlib import Path

# labelme's modules load Qt, which must not look for a screen, and report every picture they open.
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("LOGURU_LEVEL", "INFO")

# Files hold 1e-8 px and readers of double precision lose nothing more; sleap-io keeps single precision.
DOUBLE_PX = 1e-6
SINGLE_PX = 1e-3
# Coordinate of the centre of the first pixel; 0.5 in our own pixels.
FIRST_PIXEL = {"deeplabcut": 0.0, "coco": 0.0, "labelme": 0.5}


class Disagreement(Exception):
    """A reader sees something else than was exported."""


def solve(rows, right):
    """Solves a small dense system by elimination with pivoting."""
    n = len(rows)
    table = [list(row) + [value] for row, value in zip(rows, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(table[k][i]))
        table[i], table[pivot] = table[pivot], table[i]
        for k in range(n):
            if k != i:
                factor = table[k][i] / table[i][i]
                table[k] = [a - factor * b for a, b in zip(table[k], table[i])]
    return [table[i][n] / table[i][i] for i in range(n)]


def panel_from_plate(panel):
    """The map from the plate onto a panel's picture, whose sides are the means of opposite sides."""
    quad = panel["quad_px"]
    width = round(0.5 * (math.dist(quad[0], quad[1]) + math.dist(quad[3], quad[2])))
    height = round(0.5 * (math.dist(quad[0], quad[3]) + math.dist(quad[1], quad[2])))
    rows, right = [], []
    for (x, y), (u, v) in zip(quad, [(0, 0), (width, 0), (width, height), (0, height)]):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        right += [u, v]
    a, b, c, d, e, f, g, h = solve(rows, right)

    def apply(x, y):
        w = g * x + h * y + 1
        return (a * x + b * y + c) / w, (d * x + e * y + f) / w

    return apply


class Truth:
    """What the plain table says."""

    def __init__(self, folder, manifest):
        self.panels = [panel["panel"] for panel in manifest["panels"]]
        maps = {panel["panel"]: panel_from_plate(panel) for panel in manifest["panels"]}
        self.id = manifest["id"]
        self.points = {}
        with open(folder / "csv" / f"{self.id}.csv", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["state"] != "absent":
                    panel = int(row["panel"])
                    place = maps[panel](float(row["x_px"]), float(row["y_px"]))
                    self.points[panel, row["keypoint"]] = (place, row["state"], row["by"])

    def compare(self, reader, style, found, tolerance):
        """Compares {(panel, keypoint): (x, y)} of a reader with the table; returns a line for people."""
        if set(found) != set(self.points):
            extra, missing = set(found) - set(self.points), set(self.points) - set(found)
            raise Disagreement(f"{reader}: points that are not ours {sorted(extra)[:5]}, missing {sorted(missing)[:5]}")
        shift = FIRST_PIXEL[style] - 0.5
        worst = 0.0
        for key, (x, y) in found.items():
            (u, v), _, _ = self.points[key]
            worst = max(worst, math.hypot(x - u - shift, y - v - shift))
        if not worst <= tolerance:
            raise Disagreement(f"{reader}: a point of {style} lies {worst} px from ours, more than {tolerance}")
        return f"{len(found)} points agree, farthest apart {worst:.1e} px"


def only(paths, what):
    """The one path of several that there must be."""
    paths = list(paths)
    if len(paths) != 1:
        raise Disagreement(f"{what}: expected one file, found {len(paths)}")
    return paths[0]


def number(name):
    """The panel in the name of a picture: img003.png or panel_03.png."""
    return int("".join(c for c in Path(name).stem if c.isdigit()))


def labels_of(folder):
    return only((folder / "deeplabcut" / "labeled-data").glob("*/CollectedData_*.csv"), "CollectedData")


def read_pandas(folder, truth):
    """The table of labels, read as DeepLabCut reads it."""
    import pandas

    frame = pandas.read_csv(labels_of(folder), header=[0, 1, 2], index_col=[0, 1, 2])
    found = {}
    for (top, plate, image), row in frame.iterrows():
        if (top, plate) != ("labeled-data", truth.id):
            raise Disagreement(f"pandas: a row of {top}/{plate}")
        for keypoint in frame.columns.get_level_values(1).unique():
            x, y = (float(row[frame.columns[0][0], keypoint, coord]) for coord in ("x", "y"))
            if not (math.isnan(x) and math.isnan(y)):
                found[number(image), keypoint] = (x, y)
    return truth.compare("pandas", "deeplabcut", found, DOUBLE_PX)


def instances(labels, name):
    """{(panel, keypoint): (x, y)} of sleap-io's labels; `name` gives a frame's picture."""
    found = {}
    for frame in labels:
        for instance in frame.instances:
            for node, point in zip(instance.skeleton.node_names, instance.numpy()):
                if not math.isnan(point[0]):
                    found[number(name(frame)), node] = (float(point[0]), float(point[1]))
    return found


def picture_of(frame):
    files = frame.video.filename
    return files[frame.frame_idx] if isinstance(files, list) else files


def read_sleap(folder, truth):
    """The COCO file and the table of labels, as SLEAP imports them."""
    import sleap_io

    labels = sleap_io.load_coco(str(only((folder / "coco").glob("*.coco.json"), "COCO")))
    coco = truth.compare("sleap-io", "coco", instances(labels, picture_of), SINGLE_PX)
    edges = len(labels.skeletons[0].edges)
    if edges != 25:
        raise Disagreement(f"sleap-io: {edges} edges in the skeleton instead of 25")
    labels = sleap_io.load_file(str(labels_of(folder)))
    table = truth.compare("sleap-io", "deeplabcut", instances(labels, picture_of), SINGLE_PX)
    return f"COCO: {coco}, {edges} edges; DeepLabCut: {table}"


def read_labelme(folder, truth):
    """Each picture's file through labelme's own loader, which also opens the picture and compares its size."""
    import labelme

    found = {}
    for path in sorted((folder / "labelme").glob("*.json")):
        file = labelme.LabelFile(str(path))
        for shape in file.shapes:
            key = number(file.image_path), shape["label"]
            _, state, by = truth.points.get(key, (None, None, None))
            if shape["shape_type"] != "point" or shape["flags"] != {"occluded": state == "occluded"}:
                raise Disagreement(f"labelme: {key} is {shape['shape_type']} with {shape['flags']}, not {state}")
            if shape["other_data"] != {"by": by}:
                raise Disagreement(f"labelme: {key} was placed by {shape['other_data']}, not {by}")
            found[key] = tuple(shape["points"][0])
    return truth.compare("labelme", "labelme", found, DOUBLE_PX)


def read_movement(folder, truth):
    """The table with likelihoods, as movement loads results of DeepLabCut."""
    from movement.io import load_poses

    path = only((folder / "deeplabcut").glob("*DLC_*.csv"), "likelihoods")
    poses = load_poses.from_dlc_file(str(path))
    found = {}
    for frame, panel in enumerate(truth.panels):
        for keypoint in poses.keypoints.values:
            here = poses.isel(time=frame, individuals=0).sel(keypoints=keypoint)
            x, y = (float(here.position.sel(space=axis)) for axis in ("x", "y"))
            if math.isnan(x):
                continue
            found[panel, str(keypoint)] = (x, y)
            expected = {"visible": 1.0, "occluded": 0.5}.get(truth.points[panel, str(keypoint)][1])
            if float(here.confidence) != expected:
                raise Disagreement(f"movement: {keypoint} of panel {panel} has confidence {float(here.confidence)}")
    return truth.compare("movement", "deeplabcut", found, DOUBLE_PX)


READERS = [
    ("pandas", "pandas", read_pandas),
    ("sleap-io", "sleap_io", read_sleap),
    ("labelme", "labelme", read_labelme),
    ("movement", "movement", read_movement),
]


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(arguments[0])
    manifest = json.loads(Path(arguments[1]).read_text(encoding="utf-8"))
    truth = Truth(folder, manifest)
    code = 0
    for name, module, read in READERS:
        if importlib.util.find_spec(module) is None:
            print(f"skipped: {name} is not installed")
            continue
        try:
            installed = importlib.import_module(module)
        except ImportError as error:
            # Installed, but a library of the system is missing: labelme needs those of Qt.
            print(f"skipped: {name} cannot be loaded ({error})")
            continue
        try:
            print(f"{name} {getattr(installed, '__version__', '')}: {read(folder, truth)}")
        except Exception as error:  # Whatever a reader raises over our file is the file's fault until shown otherwise.
            print(f"{name}: {type(error).__name__}: {error}")
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
