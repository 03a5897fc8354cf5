"""What the scripted person does in the annotator, second part: fitting, playing, keeping what was made, looking round."""

import math
import re
import shutil
import time

from desktop import read_json
from making import MESSAGES_S, Maker

# Idle is measured for so long, s.
IDLE_S = 10.0
# Share of one processor that an idle window may use: a frame now and then, no animation.
MOST_IDLE = 0.02
# A stride that a drawing's truth is fitted to is as near as this, cm.
MOST_RMS_CM = 1.0
# Steps that are timed.
STEPS = 48


class Person(Maker):
    """The whole person."""

    def open_path(self, path):
        """Opens a file by the line of the plate browser."""
        program = self.program
        program.key("ctrl+b")
        program.fill("Path to open", str(path), role="textInput")
        program.key("Return")
        program.see(path.stem.removesuffix(".json"), role="label")
        program.settle()

    def whole_annotation(self, source):
        """The same plate with all its points, in a folder of its own."""
        folder = self.folder / "whole"
        (folder / "annotations").mkdir(parents=True)
        names = [f"{self.plate}.jpg", f"{self.plate}.json"]
        for name in names:
            shutil.copy(source.parent.parent / name, folder / name)
        return shutil.copy(source, folder / "annotations" / source.name)

    # The fit.

    def fit(self, source):
        """Opens the whole annotation, fits, looks at the worst point."""
        program = self.program
        path = self.whole_annotation(source)
        self.save()
        self.open_path(path)
        program.key("F4", "ctrl+f")
        started = time.monotonic()
        program.see("Fit of the present points.")
        print(f"  fitted after {time.monotonic() - started:.1f} s")
        found = next((re.match(r"([\d.]+) px, ([\d.]+) cm", w.name) for w in program.widgets() if "px, " in w.name), None)
        text = found.group(0) if found else "no number"
        self.check(found and float(found.group(2)) < MOST_RMS_CM, f"RMS distance from the fit: {text}")
        # Until the messages are gone.
        time.sleep(MESSAGES_S)
        self.photograph("gait")
        program.key("F2")
        self.photograph("whole-calibrated")
        program.key("F4")
        self.program.scroll_to("Worst point 1:", [1200, 700], part=True)
        program.click("Worst point 1:", part=True)
        program.settle()
        self.check(program.find("Guided", part=True), "a click on the worst point leads to the Pose page")
        self.photograph("worst-point")

    def play(self):
        """The stride moves and stops."""
        program = self.program
        program.key("F5")
        self.photograph("play")
        phase = lambda: next(w.number for w in program.widgets() if w.role == "spinButton")
        program.click("Play", role="button")
        first = phase()
        time.sleep(1.0)
        second = phase()
        program.click("Pause", role="button")
        self.check(first != second, f"the stride moves: phase {first:.3f}, a second later {second:.3f}")
        program.settle()
        self.photograph("paused")

    # Keeping.

    def killed_and_recovered(self):
        """Three more edits, a kill; the next start offers exactly that state. One undo; then it is closed and saved."""
        program = self.program
        self.save()
        self.open_path(self.annotation_path)
        program.key("F3")
        name = "near hock"
        program.click(name, role="button")
        program.key("Up", "Up", "Up")
        program.settle()
        saved = self.placed(1)["near_hock"]["at_px"]
        before = program.see(name, role="button").middle()
        program.kill()
        self.check(self.placed(1)["near_hock"]["at_px"] == saved, "the kill left the saved file as it was")
        program = self.start()
        program.see("There is unsaved work")
        told = program.see("changes,", part=True).name
        self.check(told.startswith("3 changes"), f"the next start offers: {told.split(',')[0]}")
        self.photograph("recover")
        program.click(f"Take up {self.plate}")
        program.see("not saved")
        program.key("F3", "p")
        program.settle()
        after = program.see(name, role="button").middle()
        self.check(math.dist(before, after) < 0.01, "the point is exactly where it was when the program was killed")
        program.key("ctrl+z")
        program.settle()
        self.photograph("recovered")
        program.key("ctrl+q")
        program.see("Save the changes?")
        self.photograph("save-question")
        program.click("Save them")
        self.check(program.ended() == 0, "the program ends after saving")
        at = self.placed(1)["near_hock"]["at_px"]
        moved = [round(now - then, 2) for now, then in zip(at, saved)]
        self.check(moved == [0.0, -2.0], f"saved: three nudges less the one undone, {moved} px")

    def export(self):
        """DeepLabCut and COCO, by the window."""
        program = self.start(self.annotation_path)
        folder = self.annotation_path.parent / f"{self.plate}-export"
        for shown, wanted, ending in [(None, "deeplabcut", ".csv"), ("deeplabcut", "coco", ".json")]:
            program.key("ctrl+e")
            program.see("Folder", role="textInput")
            if shown:
                program.click(shown, role="comboBox", part=True)
                program.click(wanted, role="button", part=True)
                self.photograph("export")
            program.click("Export", role="button")
            program.see("files written to", part=True)
            time.sleep(0.3)
            files = sorted(path for path in folder.rglob("*") if path.suffix == ending and path.stat().st_size)
            self.check(files, f"{wanted}: {[path.name for path in files]}")
            program.click("Close window")

    # Looking round.

    def command_list(self):
        """A command by its name; the light theme."""
        program = self.program
        program.key("F3", "ctrl+shift+p")
        program.see("Search commands")
        program.type("light")
        self.photograph("commands")
        program.key("Return")
        program.settle()
        self.photograph("light")
        program.key("F2")
        self.photograph("light-calibrate")

    def keys(self):
        """Another key for a command."""
        program = self.program
        program.key("ctrl+comma")
        program.click(program.scroll_to("Key of Light or dark", [680, 600]))
        program.key("ctrl+shift+l")
        self.photograph("keys")
        program.click("Close window")
        program.key("ctrl+shift+l")
        program.settle()
        kept = read_json(self.state / "settings.json")["keys"]
        self.check("Ctrl+Shift+L" in str(kept), f"the chosen key is kept: {kept}")
        self.photograph("dark-again")

    def browse(self):
        """Plates on this machine, and the catalogue."""
        program = self.program
        program.key("ctrl+b")
        program.see("On this machine")
        self.photograph("plates")
        program.click("Animal Locomotion, 1887")
        program.settle()
        self.photograph("catalogue")
        program.click("Close window")

    # Measures.

    def measure(self):
        """Start, idling, stepping."""
        program = self.program
        program.key("F3")
        print(f"  {program.printed[0] if program.printed else 'no time of start printed'}")
        time.sleep(MESSAGES_S)
        before = program.cpu_s()
        time.sleep(IDLE_S)
        share = (program.cpu_s() - before) / IDLE_S
        self.check(share <= MOST_IDLE, f"idle: {100 * share:.1f} % of a processor over {IDLE_S:.0f} s")
        before, started = program.cpu_s(), time.monotonic()
        program.screen.tool("key", "--delay", 40, "--repeat", STEPS, "period")
        program.settle()
        passed, used = time.monotonic() - started, program.cpu_s() - before
        print(
            f"  {STEPS} steps held: {1000 * passed / STEPS:.0f} ms each, "
            f"{1000 * used / STEPS:.0f} ms of a processor with the graphics card in software"
        )

    def leave(self):
        """Saves and ends the program."""
        self.save()
        self.program.key("ctrl+q")
        self.check(self.program.ended() == 0, "the program ends")
