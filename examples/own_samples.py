# SPDX-License-Identifier: Apache-2.0
"""The steps of docs/how-to-stamp-own-samples.md: when samples were taken, by the log of
kinalign time-server --json.

own_samples.py LOG reads lines of four whole numbers, stream, boot_id, lives and the node's counter
at the sample in ns, and prints of each the likeliest time and the ends of its interval, ns on the
raw clock of the server, or that it has no certificate."""
import bisect
import json
import math
import sys

CUTS = ("new_boot", "step", "slip", "settled")
MARGIN_NS = 10**9  # a line does not say when its frame arrived, but it was less than that later
LATEST_WITHDRAWAL_NS = 130 * 10**9  # a truncated log may lack a withdrawal of up to this long before its end
WIDENING = 1e-4  # H2: the interval grows by this much on each side, per second between a sample and its line


class Run:
    """The certified lines of a stream between two cuts, all from one clock."""

    def __init__(self, begin_ns):
        self.begin_ns, self.end_ns, self.lines = begin_ns, math.inf, []

    def nearest(self, boot_id, lives, n):
        """The line whose counter is nearest to n. Lines are sorted by counter. None if boot_id or lives differ."""
        at = bisect.bisect(self.lines, n, key=lambda line: line["counter_ns"])
        neighbours = [line for line in self.lines[max(at - 1, 0) : at + 1]
                      if (line["boot_id"], line["lives"]) == (boot_id, lives)]
        return min(neighbours, key=lambda line: abs(line["counter_ns"] - n), default=None)


class Stamper:
    def __init__(self, lines):
        """`lines`: the parsed lines of the log in their order; the order says between which cuts each line is."""
        self.runs, self.withdrawn = {}, {}
        begun, stopped = False, False
        for line in lines:
            if line["event"] == "missed" or line.get("missed_events"):
                raise ValueError("lines are missing in it, and one may have been a step or a withdrawal")
            if line["event"] == "started" and (begun or self.runs):
                raise ValueError("it is of several runs of the server; give each a file of its own, from its line "
                                 "`started` on")
            begun, stopped = begun or line["event"] == "started", line["event"] == "stopped"
            kind = line.get("kind") if line["event"] == "clock_event" else line.get("certainty")
            runs = self.runs.setdefault(line["stream"], []) if "stream" in line else []
            if kind in CUTS:
                for run in runs[-1:]:
                    run.end_ns = line["begin_ns"]
                runs.append(Run(line["begin_ns"]))
            elif kind == "withdrawn":
                self.withdrawn.setdefault(line["stream"], []).append((line["begin_ns"], line["end_ns"]))
            elif kind == "certified":
                if not runs:  # the log begins in the middle
                    runs.append(Run(line["time_ns"]))
                runs[-1].lines.append(line)
        for stream, runs in self.runs.items():
            times = [line["time_ns"] for run in runs for line in run.lines]
            if times:  # times after the log's last line are not certified
                runs[-1].end_ns = min(runs[-1].end_ns, max(times) + MARGIN_NS)
            if times and not stopped:
                self.withdrawn.setdefault(stream, []).append((max(times) - LATEST_WITHDRAWAL_NS, math.inf))
            for run in runs:
                run.lines = [line for line in run.lines if not self.is_withdrawn(stream, line["time_ns"])]

    def is_withdrawn(self, stream, ns):
        return any(begin - MARGIN_NS <= ns <= end + MARGIN_NS for begin, end in self.withdrawn.get(stream, ()))

    def stamp(self, stream, boot_id, lives, n):
        """(time, earliest, latest), or None where nothing is certified; n: the counter, ns."""
        found = []
        for run in self.runs.get(stream, ()):
            line = run.nearest(boot_id, lives, n)
            if line is None:
                continue
            after = n - line["counter_ns"]
            wider = math.ceil(abs(after) * WIDENING)
            time = line["time_ns"] + after + round(after * line["drift_ppm"] / 1e6)
            ends = line["earliest_ns"] + after - wider, line["latest_ns"] + after + wider
            if run.begin_ns <= time < run.end_ns and not self.is_withdrawn(stream, time):
                found.append((abs(after), time, *ends))
        return min(found)[1:] if found else None


def parsed(log):
    """Its lines; what a disk that was full has left of the last one is passed over."""
    texts = log.read().splitlines(keepends=True)
    for number, text in enumerate(texts, 1):
        try:
            line = json.loads(text)
            if not isinstance(line, dict) or "event" not in line:
                raise ValueError
            yield line
        except ValueError:
            if number < len(texts) or text.endswith("\n"):
                raise ValueError(f"line {number}: expected a line of kinalign time-server --json, found "
                                 f"{text[:40]!r}") from None


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: own_samples.py LOG <ROWS    (docs/how-to-stamp-own-samples.md)")
    try:
        with open(sys.argv[1], encoding="utf-8") as log:
            stamper = Stamper(parsed(log))
    except (OSError, ValueError) as error:
        sys.exit(f"own_samples.py: {sys.argv[1]}: {error}")
    for number, row in enumerate(sys.stdin, 1):
        try:
            stream, boot_id, lives, n = map(int, row.split())
        except ValueError:
            sys.exit(f"own_samples.py: row {number}: expected stream, boot_id, lives and counter_ns, found {row!r}")
        stamp = stamper.stamp(stream, boot_id, lives, n)
        print(*stamp if stamp else ("not certified",))


if __name__ == "__main__":
    main()
