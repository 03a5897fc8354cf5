"""What the scripted person does in the annotator, step by step; first part: from a picture to an annotation."""

import itertools
import math
import re
import statistics
import time

from desktop import Program, read_json

# Share of the canvas that a whole panel fills (crates/annotator/src/canvas.rs).
FILLED = 0.94
# Panels whose every point is placed by hand; the next ones are proposed.
BY_HAND = 2
# A click hits what it is meant for to half a point of the screen, which is less than this on the plate, px.
HIT_PX = 1.0
# Lanes of the footfall bar, as their keys 1 to 4.
LANES = ("near_fore", "off_fore", "near_hind", "off_hind")
# Panels of a plate, here.
PANELS = 12
# Messages are gone after this, s.
MESSAGES_S = 7.0
# Panels of a plate, here.


class Maker:
    """A person at work on one plate, who sees in it what `truth` says."""

    def __init__(self, screen, path, folder, out, plate, truth):
        self.screen, self.path, self.folder, self.out, self.plate = screen, path, folder, out, plate
        self.truth = truth
        self.state = folder / "state"
        self.state.mkdir()
        self.manifest_path = folder / f"{plate}.json"
        self.annotation_path = folder / "annotations" / f"{plate}.json"
        self.program, self.pictures, self.failures = None, 0, []

    def start(self, *paths):
        """Starts the program."""
        self.program = Program(self.screen, self.path, self.state, ["--plates", self.folder, *paths])
        self.program.settle()
        return self.program

    def photograph(self, name):
        """A screenshot, numbered."""
        self.program.settle()
        self.pictures += 1
        self.screen.photograph(self.out / f"{self.plate}-{self.pictures:02d}-{name}.png")

    def check(self, true, what):
        """Something that should be so."""
        print(f"  {'ok' if true else 'NOT SO'}: {what}", flush=True)
        if not true:
            self.failures.append(what)

    def annotation(self):
        """The annotation as it is on disk."""
        return read_json(self.annotation_path)

    def placed(self, panel):
        """Keypoints of a panel as they are on disk."""
        panels = [p for p in self.annotation()["panels"] if p["panel"] == panel]
        return panels[0]["keypoints"] if panels else {}

    def save(self):
        """Saves, and waits until it is done."""
        self.program.key("ctrl+s")
        self.program.see("saved")

    def screen_from_plate(self, panel):
        """The map from plate px to the screen while a whole panel is shown."""
        quads = {p["panel"]: p["quad_px"] for p in read_json(self.manifest_path)["panels"]}
        low, high = ([end(c[i] for c in quads[panel]) for i in (0, 1)] for end in (min, max))
        x0, y0, x1, y1 = self.program.see("Photograph", role="canvas").bounds
        zoom = FILLED * min((x1 - x0) / (high[0] - low[0]), (y1 - y0) / (high[1] - low[1]))
        return lambda at: [
            middle + zoom * (at[i] - 0.5 * (low[i] + high[i]))
            for i, middle in enumerate([(x0 + x1) / 2, (y0 + y1) / 2])
        ]

    # First start.

    def first_start(self):
        """Without an argument: a specimen and the tour, to its end."""
        program = self.start()
        program.see("Tour")
        self.check(program.find("1 of 7"), "the first start shows a tour")
        self.photograph("tour")
        for step in range(2, 8):
            program.click("Next")
            program.see(f"{step} of 7")
        self.photograph("tour-end")
        program.click("Done")
        self.check(not program.find("7 of 7"), "the tour ends")
        program.key("ctrl+q")
        self.check(program.ended() == 0, "nothing was changed, so nothing is asked at the end")

    # Plate page.

    def open_picture(self):
        """A bare picture as argument."""
        program = self.start(self.folder / f"{self.plate}.jpg")
        program.see("0 panels", part=True)
        program.key("F1")
        self.photograph("opened")

    def split(self):
        """Finds the panels, drags a corner and takes that back."""
        program = self.program
        before = time.monotonic()
        program.click("Find panels")
        program.see(f"{PANELS} panels, read in", part=True)
        print(f"  panels found after {time.monotonic() - before:.1f} s")
        corner = program.see("Panel 1 top left").middle()
        program.drag(corner, [corner[0] + 25, corner[1] + 18])
        moved = program.see("Panel 1 top left").middle()
        self.check(math.dist(corner, moved) > 20, "a corner can be dragged")
        program.key("ctrl+z")
        program.settle()
        back = program.see("Panel 1 top left").middle()
        self.check(math.dist(corner, back) < 0.01, "one undo takes the whole drag back")
        self.photograph("split")

    def name_plate(self, gait, title):
        """Gait of the title, title, facing."""
        program = self.program
        program.click("Gait of the title:", part=True, role="comboBox")
        program.click(gait, role="button")
        program.fill("Title", title, role="textInput")
        program.click("Right", role="button")
        program.see("The animal faces right", part=True)
        self.save()
        manifest = read_json(self.manifest_path)
        told = (manifest["gait"], manifest["title"], manifest["facing"], len(manifest["panels"]))
        self.check(told == (gait, title, "right", PANELS), f"the manifest on disk says {told}")
        self.photograph("named")

    # Calibrate page.

    def calibrate(self, numbers):
        """Ground, uprights, a known length, where the cameras stand, time: `numbers` by the names of their fields."""
        program = self.program
        program.key("F2")
        program.click("Find the ground lines")
        program.see(f"Drawn in {PANELS} of {PANELS} panels", part=True)
        self.photograph("ground")
        program.click("A length in the picture is known")
        program.click("A row of cameras, evenly spaced")
        program.click("The interval between panels is known")
        program.click("Begin calibration")
        self.draw_length()
        program.click("Find uprights")
        program.see("Uprights taken as marks", part=True)
        program.click("Number all panels alike")
        self.photograph("marks")
        self.type_numbers(numbers)
        self.photograph("calibrated")

    def draw_length(self):
        """A known length drawn between two uprights of the first panel; then taken back, as all are found anyway."""
        program, screen = self.program, self.screen_from_plate(1)
        marks = [mark["at_px"] for mark in self.truth["panels"][0]["marks"]]
        program.click("Draw a known length")
        program.drag(screen(marks[0]), screen(marks[1]))
        program.type("0.6858")
        program.key("Return")
        self.photograph("known-length")
        typed = program.see("Known length", role="textInput").value
        self.check(typed == "0.6858", f"a known length is drawn, and {typed} m is typed")
        program.key("ctrl+z", "ctrl+z")
        program.settle()
        self.check(not program.find("Mark 1"), "typing and drawing are taken back")

    def type_numbers(self, numbers):
        """Types into fields at the right, wherever they are."""
        program = self.program
        x0, _, x1, y1 = program.see("Photograph", role="canvas").bounds
        inside = [x1 + 150, 700]
        for name, text in numbers:
            if name.startswith("= "):
                shown, chosen = name[2:], text
                program.click(program.scroll_to(shown, inside, part=True, role="comboBox"))
                program.click(chosen, role="button")
            else:
                widget = program.scroll_to(name, inside, role="textInput")
                program.click(widget)
                program.key("ctrl+a")
                program.type(text)
                program.key("Return")

    def scale(self, truth_px_per_m):
        """The scale that follows, read off the Calibrate page."""
        program = self.program
        program.key("F2")
        numbers = lambda: [w.name for w in program.widgets() if re.match(r"[\d.]+ ± [\d.]+ px/m", w.name)]
        told = program.wait(numbers, "the scale on the track")[0]
        self.photograph("scale")
        px_per_m = float(told.split()[0])
        near = truth_px_per_m is None or abs(px_per_m / truth_px_per_m - 1) < 0.02
        self.check(near, f"the scale on the track follows: {told}")
        program.key("F3")

    # Pose page.

    def pose_by_hand(self):
        """Two panels, point by point in the drawn order."""
        program = self.program
        program.key("F3")
        for panel in range(1, BY_HAND + 1):
            screen, truth = self.screen_from_plate(panel), self.truth_of(panel)
            started = time.monotonic()
            for name in self.drawn_order(truth):
                state = truth[name]["state"]
                if state != "visible":
                    program.key("x" if state == "absent" else "o")
                if state != "absent":
                    program.click(screen(truth[name]["at_px"]))
            print(f"  panel {panel}: {len(truth)} points in {time.monotonic() - started:.0f} s")
            self.photograph(f"panel-{panel}")
            program.key("period")
        self.save()
        for panel in range(1, BY_HAND + 1):
            self.compare(panel, HIT_PX, "placed by hand")

    def drawn_order(self, truth):
        """Names of the points from the top to the bottom of the list at the right: the order they are asked in."""
        edge = self.program.see("Photograph", role="canvas").bounds[2]
        listed = [w.name.replace(" ", "_") for w in self.program.widgets() if w.role == "button" and w.bounds[0] > edge]
        return [name for name in listed if name in truth]

    def truth_of(self, panel):
        """What the person sees in a panel."""
        return next(p["keypoints"] for p in self.truth["panels"] if p["panel"] == panel)

    def compare(self, panel, most_px, how):
        """Points on disk against what the person saw."""
        placed, truth = self.placed(panel), self.truth_of(panel)
        self.check(set(placed) == set(truth), f"panel {panel} has {len(placed)} points")
        pairs = [(placed[name]["at_px"], truth[name]["at_px"]) for name in placed if placed[name].get("at_px")]
        apart = [math.dist(a, b) for a, b in pairs if b]
        median = statistics.median(apart) if apart else math.inf
        text = f"panel {panel} {how}: median {median:.2f} px, worst {max(apart, default=math.inf):.1f} px off"
        self.check(median <= most_px, text)
        states = all(placed[name]["state"] == truth[name]["state"] for name in placed)
        self.check(how != "placed by hand" or states, f"panel {panel}: seen and guessed are as told")

    def correct(self):
        """A point is chosen, nudged, made a guess; all of it is undone and redone."""
        program = self.program
        program.key("comma")
        handle = program.see("near hock", role="button").middle()
        program.click(handle)
        program.key("Right", "Right", "shift+Down")
        program.settle()
        nudged = program.see("near hock", role="button").middle()
        self.check(nudged[0] - handle[0] > 2 and nudged[1] > handle[1], "arrow keys nudge, Shift finer")
        program.key("ctrl+z", "ctrl+z", "ctrl+z")
        program.settle()
        self.check(math.dist(handle, program.see("near hock", role="button").middle()) < 0.01, "undone")
        program.key("ctrl+shift+z")
        program.settle()
        self.check(program.see("near hock", role="button").middle()[0] > handle[0] + 1, "done again")
        program.key("ctrl+z", "m")
        program.point([handle[0] + 30, handle[1] + 10])
        self.photograph("magnifier")
        program.key("m")

    def drag_skeleton(self):
        """The skeleton by its hock: the leg follows."""
        program = self.program
        program.key("k")
        hock = program.see("near hock", role="button").middle()
        before = program.see("near hind hoof", role="button").middle()
        # Until the messages are gone.
        time.sleep(MESSAGES_S)
        shown = lambda: self.photograph("skeleton")
        program.drag(hock, [hock[0] - 45, hock[1] - 30], steps=12, held=shown)
        after = program.see("near hind hoof", role="button").middle()
        self.check(math.dist(before, after) > 10, "the hoof follows the hock")
        program.key("ctrl+z")
        program.settle()
        back = program.see("near hind hoof", role="button").middle()
        self.check(math.dist(before, back) < 0.01, "one undo takes the whole drag back")
        program.key("p")

    def propose(self, most_px):
        """The third panel is tracked, the fourth copied and then interpolated."""
        program = self.program
        program.key("period", "t")
        program.see("tracked", part=True)
        self.photograph("tracked")
        program.key("period", "c")
        program.settle()
        self.photograph("copied")
        program.key("ctrl+z", "i")
        program.settle()
        self.photograph("interpolated")
        program.key("ctrl+z")
        self.save()
        self.compare(3, most_px, "tracked")
        self.check(not self.placed(4), "a copied and an interpolated pose are taken back")

    def look_round(self):
        """Steps by keys, ghosts, hoof trails, contact sheet."""
        program = self.program
        program.key("comma", "g", "shift+g", "h")
        self.photograph("ghosts")
        program.key("shift+g", "h", "a")
        self.photograph("sheet")
        self.check(not program.find("Photograph", role="canvas"), "A shows all panels at once")
        program.key("a")
        for _ in range(PANELS):
            program.key("period")
        self.check(program.find(f"Panel 3 of {PANELS}"), "twelve steps lead round the stride")

    # Footfalls.

    def draw_stance(self, lane, panels):
        """Drags over the panels of one lane in which the hoof is down, when it is down once; those panels."""
        x0, y0, x1, y1 = self.program.see(f"Footfalls {lane}").bounds
        width, y = (x1 - x0) / PANELS, (y0 + y1) / 2
        first, last = min(panels), max(panels)
        if last - first + 1 != len(panels):
            return []
        self.program.drag([x0 + (first - 0.9) * width, y], [x0 + (last - 0.1) * width, y])
        return panels

    def contacts(self):
        """One lane's stance is drawn, the rest is told by keys panel by panel; then an edge is dragged."""
        program = self.program
        seen = {p["panel"]: p["contacts"] for p in self.truth["panels"]}
        down = self.draw_stance("near fore", [panel for panel in seen if seen[panel]["near_fore"] == "stance"])
        program.click("Panel 1", role="button")
        for panel in seen:
            drawn = {"near_fore": "stance"} if panel in down else {}
            for key, lane in enumerate(LANES, 1):
                wanted, now = seen[panel][lane], drawn.get(lane, "unknown")
                if wanted != now:
                    program.key(*[str(key)] * ["unknown", "stance", "swing"].index(wanted))
            program.key("period")
        self.photograph("contacts")
        self.save()
        now = {p["panel"]: p["contacts"] for p in self.annotation()["panels"]}
        wrong = [
            f"panel {panel} {lane} is {now.get(panel, {}).get(lane)}"
            for panel, lane in itertools.product(seen, LANES)
            if now.get(panel, {}).get(lane) != seen[panel][lane]
        ]
        self.check(not wrong, f"every label is as told {', '.join(wrong)}")
        edge = next(w for w in program.widgets() if " lift-off " in w.name and 300 < w.middle()[0] < 900)
        at = edge.middle()
        program.drag(at, [at[0] + 12, at[1]])
        program.settle()
        moved = [w for w in program.widgets() if w.name.split(" lift-off")[0] == edge.name.split(" lift-off")[0]]
        self.check(any(abs(w.middle()[0] - at[0] - 12) < 2 for w in moved), f"{edge.name}: dragged to where it is")
        program.key("ctrl+z")
