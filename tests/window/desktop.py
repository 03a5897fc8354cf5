"""A screen of its own, the annotator on it, and a hand: pointer and keys by xdotool, places by name.

Places and values are read from the program's tree for screen readers, which the cargo feature `inspection` of the
package `annotator` serves on a port of this machine. Nothing is done through that port: every click and key goes
through the X server, as a person's does.
"""

import json
import os
import shutil
import signal
import socket
import struct
import subprocess
import threading
import time

# Size of the screen, px: that of the program's window when it is started for the first time.
SCREEN = (1360, 880)
# Flag of a widget that is disabled, in AccessKit's order of flags.
DISABLED = 1 << 9
# Nothing that is scrolled is seen above this, points.
TOP = 110
# The longest that anything is waited for, s.
PATIENCE = 30.0
# Between two looks, and between the parts of a gesture, s.
GLANCE = 0.05


class Failure(Exception):
    """Something is not as a person would expect it."""


def missing():
    """What this script needs and this machine does not have."""
    programs = [name for name in ("Xvfb", "xdotool", "import") if shutil.which(name) is None]
    try:
        import msgpack  # noqa: F401
    except ImportError:
        programs.append("msgpack (pip)")
    return programs


class Screen:
    """An X server on a free display."""

    def __init__(self):
        reading, writing = os.pipe()
        size = f"{SCREEN[0]}x{SCREEN[1]}x24"
        command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", size, "-nolisten", "tcp"]
        self.server = subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise Failure("Xvfb gives no display")
        self.environment = dict(os.environ, DISPLAY=f":{number}")

    def close(self):
        """Ends the server."""
        self.server.terminate()
        self.server.wait()

    def tool(self, *words):
        """One call of xdotool."""
        command = ["xdotool", *map(str, words)]
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=PATIENCE)
        return done.stdout.strip()

    def photograph(self, path):
        """A picture of the whole screen."""
        subprocess.run(["import", "-window", "root", str(path)], env=self.environment, check=True)


class Widget:
    """A widget as a screen reader is told of it."""

    def __init__(self, node):
        self.role, _, _, flags, told = node
        self.value = (told.get("value") or "").strip()
        self.name = (told.get("label") or "").strip() or self.value
        self.number = told.get("numericValue")
        self.selected = told.get("selected", False) or told.get("toggled") == "true"
        self.enabled = not flags & DISABLED
        self.bounds = told.get("bounds")

    def middle(self):
        """Its middle on the screen, points."""
        x0, y0, x1, y1 = self.bounds
        return [(x0 + x1) / 2, (y0 + y1) / 2]


class Program:
    """The annotator, running; and the hand that uses it."""

    def __init__(self, screen, path, state, arguments=()):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        environment = dict(
            screen.environment,
            EGUI_INSPECTION=f"127.0.0.1:{port}",
            MUYBRIDGE_STATE=str(state),
            XDG_DATA_HOME=str(state / "window"),
            LIBGL_ALWAYS_SOFTWARE="1",
        )
        environment.pop("WAYLAND_DISPLAY", None)
        self.screen, self.printed = screen, []
        command = [str(path), "--report-start", *map(str, arguments)]
        self.process = subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        threading.Thread(target=self._listen, daemon=True).start()
        self.link = self._connect(port)
        self.wait(self._focus, "a window with the keyboard")

    def _focus(self):
        """Gives the window the keyboard, which a window manager would do; whether it has it."""
        windows = self.screen.tool("search", "--onlyvisible", "--name", "Muybridge annotator").split()
        if windows:
            self.screen.tool("windowfocus", windows[0])
        return windows and self.screen.tool("getwindowfocus") == windows[0]

    def _listen(self):
        for line in self.process.stdout:
            self.printed.append(line.rstrip())

    def _connect(self, port):
        deadline = time.monotonic() + PATIENCE
        while True:
            if self.process.poll() is not None:
                raise Failure("the program ended at once: " + " ".join(self.printed))
            try:
                link = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
                break
            except OSError:
                if time.monotonic() > deadline:
                    raise Failure("nothing listens: built without the feature `inspection`?") from None
                time.sleep(GLANCE)
        magic, version = struct.unpack(">4sI", self._read(link, 8))
        if (magic, version) != (b"eins", 1):
            raise Failure(f"the inspection protocol is {magic!r}, version {version}")
        return link

    @staticmethod
    def _read(link, count):
        data = b""
        while len(data) < count:
            part = link.recv(count - len(data))
            if not part:
                raise Failure("the program has ended")
            data += part
        return data

    def widgets(self):
        """All widgets of the present frame, from the top to the bottom."""
        import msgpack

        body = msgpack.packb("GetTree")
        self.link.sendall(struct.pack(">I", len(body)) + body)
        (length,) = struct.unpack(">I", self._read(self.link, 4))
        answer = msgpack.unpackb(self._read(self.link, length), strict_map_key=False)
        if "Tree" not in answer:
            raise Failure(f"no tree: {str(answer)[:200]}")
        update = answer["Tree"][2]
        widgets = [Widget(node) for _, node in update[0]] if update else []
        # A run of text repeats the words of the label that it belongs to.
        widgets = [widget for widget in widgets if widget.bounds and widget.role != "textRun"]
        return sorted(widgets, key=lambda widget: (widget.bounds[1], widget.bounds[0]))

    def find(self, name, role=None, part=False, at=0):
        """The widget of this name (or with this in its name), or none."""
        fits = (lambda widget: name in widget.name) if part else (lambda widget: name == widget.name)
        found = [w for w in self.widgets() if fits(w) and role in (None, w.role)]
        return found[at] if len(found) > at else None

    def see(self, name, role=None, part=False, at=0, patience=PATIENCE):
        """The widget of this name, which is waited for."""
        return self.wait(lambda: self.find(name, role, part, at), f"“{name}”", patience)

    def wait(self, look, what, patience=PATIENCE):
        """Waits until something is there."""
        deadline = time.monotonic() + patience
        while True:
            found = look()
            if found:
                return found
            if time.monotonic() > deadline:
                raise Failure(f"{what} is not there after {patience:.0f} s")
            time.sleep(GLANCE)

    def settle(self, patience=PATIENCE):
        """Waits until nothing moves or changes between two looks."""

        def still():
            before = [(w.name, w.value, w.bounds) for w in self.widgets()]
            time.sleep(GLANCE)
            return before == [(w.name, w.value, w.bounds) for w in self.widgets()]

        self.wait(still, "rest", patience)

    def rest(self):
        """Waits until what was done is on the screen: what is typed goes where the click has led."""
        time.sleep(GLANCE)
        try:
            self.widgets()
        except (Failure, OSError):
            # Ctrl+Q ends the program; who waits for something else will not find it.
            pass

    def point(self, place):
        """Moves the pointer."""
        self.screen.tool("mousemove", round(place[0]), round(place[1]))

    def click(self, target, button=1, **where):
        """Clicks a place, a widget, or a widget of this name."""
        if isinstance(target, str):
            target = self.see(target, **where)
        place = target.middle() if isinstance(target, Widget) else target
        self.point(place)
        time.sleep(GLANCE)
        # Down and up at once: on a slow screen a pause could last for a second, which is no click any more.
        self.screen.tool("click", button)
        self.rest()

    def drag(self, start, end, steps=8, held=None):
        """Drags from a place to another; `held` is done before the button is let go."""
        self.point(start)
        time.sleep(GLANCE)
        self.screen.tool("mousedown", 1)
        for step in range(1, steps + 1):
            share = step / steps
            self.point([a + share * (b - a) for a, b in zip(start, end)])
            time.sleep(0.03)
        if held:
            held()
        self.screen.tool("mouseup", 1)
        self.rest()
        self.rest()

    def scroll(self, place, clicks):
        """Turns the wheel over a place; downwards when positive."""
        self.point(place)
        self.screen.tool("click", "--repeat", abs(clicks), "--delay", 30, 5 if clicks > 0 else 4)
        time.sleep(0.3)

    def key(self, *keys):
        """Presses keys one after the other."""
        for key in keys:
            self.screen.tool("key", key)
            self.rest()

    def type(self, text):
        """Types."""
        self.screen.tool("type", "--delay", 15, text)
        time.sleep(2 * GLANCE)

    def fill(self, name, text, **where):
        """Puts a text in the place of a field's."""
        self.click(name, **where)
        self.key("ctrl+a")
        self.type(text)

    def scroll_to(self, name, inside, **where):
        """Brings a widget of a scrolled column into view; `inside` is a place in the column."""
        for _ in range(30):
            widget = self.see(name, **where)
            y = widget.middle()[1]
            if TOP < y < inside[1]:
                return widget
            self.scroll([inside[0], (TOP + inside[1]) / 2], 2 if y > TOP else -2)
        raise Failure(f"“{name}” cannot be scrolled to")

    def cpu_s(self):
        """Seconds of processor time used so far."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def kill(self):
        """Ends the program as a power cut does."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        self.link.close()

    def stop(self):
        """Ends the program, if it still runs, and lets go of it."""
        if self.process.poll() is None:
            self.kill()

    def ended(self, patience=PATIENCE):
        """Waits until the program has ended by itself; its exit code."""
        try:
            return self.process.wait(patience)
        except subprocess.TimeoutExpired:
            raise Failure("the program does not end") from None


def read_json(path):
    """A file of the program."""
    with open(path, encoding="utf-8") as file:
        return json.load(file)
