#!/usr/bin/env python3
"""How long the language server takes, and what it then says: bench/lsp/measure.py FATHOM [EDITS].

Types the sessions of sessions.json letter by letter into texts of 1,000 and 10,000 lines, as an
editor does: after a letter it waits for the diagnostics, or asks for completion at once. Prints the
95th percentile of each, by the clock and of the server's processor time, which are the same on a
machine that does nothing else, and the server's memory over EDITS edits (100,000 unless said). Ends
with 1 where an answer says something else than the session wants, or where a request is not
answered; never for a time.
"""
import json
import pathlib
import sys
import tempfile
import time

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent
sys.path.insert(0, str(root / "tests" / "editors"))
from server import Server  # noqa: E402

goals = {1000: 50, 10000: 300}  # milliseconds, for diagnostics
answer_goal = 20  # … and for hover and completion


def long_text(lines):
    """bench/scenes/typical.sdf, as often as makes so many lines, with its numbers counted up."""
    block = (root / "bench" / "scenes" / "typical.sdf").read_text()
    return "".join(block.replace("let at_0 = 0", f"let at_0 = {n}").replace("_0", f"_{n}")
                   for n in range(-(-lines // block.count("\n"))))


class Text:
    """A text that is open in the server, and where the next letter goes."""

    def __init__(self, server, uri, text):
        self.server, self.uri, self.text, self.version, self.at = server, uri, text, 1, 0
        server.open(uri, text)

    def place(self, offset=None):
        before = self.text[:self.at if offset is None else offset]
        return {"line": before.count("\n"), "character": len(before) - before.rfind("\n") - 1}

    def params(self, offset=None):
        return {"textDocument": {"uri": self.uri}, "position": self.place(offset)}

    def type(self, letter):
        """One edit; `\\b` takes the letter before."""
        begin = self.at - 1 if letter == "\b" else self.at
        letter = "" if letter == "\b" else letter
        change = {"range": {"start": self.place(begin), "end": self.place()}, "text": letter}
        self.text = self.text[:begin] + letter + self.text[self.at:]
        self.at = begin + len(letter)
        self.version += 1
        self.server.notify("textDocument/didChange",
                           {"textDocument": {"uri": self.uri, "version": self.version}, "contentChanges": [change]})

    def diagnostics(self):
        """Waits for those of the present version."""
        while True:
            message = self.server.notifications.pop(0) if self.server.notifications else self.server.receive()
            if (message.get("method") == "textDocument/publishDiagnostics"
                    and message["params"].get("version") == self.version):
                return message["params"]["diagnostics"]


def processes(server):
    pids = [server.process.pid]
    for pid in pids:
        pids += map(int, pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split())
    return pids


def processor(server):
    """Seconds that the server's processes have computed: Linux' clock of another process."""
    return sum(time.clock_gettime((~pid << 3) | 2) for pid in processes(server))


def timed(server, work):
    """Milliseconds by the clock, those of the processor, and the result."""
    begin, used = time.perf_counter(), processor(server)
    result = work()
    return (time.perf_counter() - begin) * 1e3, (processor(server) - used) * 1e3, result


def percentile(values):
    return sorted(values)[min(len(values) - 1, int(0.95 * len(values)))]


def memory(server):
    """KiB that the server's processes hold."""
    return sum(int(line.split()[1]) for pid in processes(server)
               for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines() if line.startswith("VmRSS"))


def play(text, session, n, times):
    """Types a session into the block number n; says what is wrong, or nothing."""
    session = {key: value.replace("{n}", str(n)) for key, value in session.items()}
    text.at = text.text.index(session["below"] + "\n") + len(session["below"])
    begin = text.at
    for number, letter in enumerate(session["type"]):
        def after():
            text.type(letter)
            if number % 2 == 0:
                return text.diagnostics()
            return text.server.request("textDocument/completion", text.params())
        times["diagnostics" if number % 2 == 0 else "completion"].append(timed(text.server, after)[:2])
        if number % 2:
            text.diagnostics()
        else:
            times["hover"].append(timed(text.server, lambda: text.server.request(
                "textDocument/hover", text.params(text.at - 2)))[:2])
    text.type(" ")
    left = text.diagnostics()
    if left:
        return f"there are diagnostics left: {left[0]['message']}"
    at = text.text.index(session["hover"], begin)
    said = text.server.request("textDocument/hover", text.params(at + 1))
    if not said or session["says"] not in said["contents"]["value"]:
        return f"hover does not say `{session['says']}`: {said}"
    return None


def main():
    program, edits = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 100_000
    sessions = json.loads((here / "sessions.json").read_text())
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        uri = pathlib.Path(folder, "a.sdf").as_uri()
        for lines, goal in goals.items():
            server = Server(program)
            times = {"diagnostics": [], "completion": [], "hover": []}
            text = Text(server, uri, long_text(lines))
            text.diagnostics()
            for session in sessions:
                said = play(text, session, 7, times)
                if said:
                    wrong.append(f"{lines} lines, {session['name']}: {said}")
            print(f"{lines} lines, 95th percentiles:")
            for what, all_times in times.items():
                limit = goal if what == "diagnostics" else answer_goal
                clock, used = (percentile(one) for one in zip(*all_times))
                print(f"  {what:12} {clock:7.1f} ms, of the processor {used:6.1f} ms; goal {limit} ms"
                      f"{' !' if used > limit else ''}  ({len(all_times)} times)")
            server.close()
        server = Server(program)
        text = Text(server, uri, long_text(50))
        text.diagnostics()
        at = len(text.text)
        before = 0
        begin = time.perf_counter()
        for number in range(edits):
            text.at = at + number % 2
            text.type("\b" if number % 2 else " 1"[number // 2 % 2])
            text.diagnostics()
            if number == min(1000, edits // 2):
                before = memory(server)
        print(f"{edits} edits of 50 lines: {(time.perf_counter() - begin) / edits * 1e3:.2f} ms each, "
              f"memory {before / 1024:.1f} MiB after the first, {memory(server) / 1024:.1f} MiB at the end")
        server.close()
    for line in wrong:
        print("measure.py: " + line, file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main())
