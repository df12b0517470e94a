# SPDX-License-Identifier: Apache-2.0
"""The recipe "One's own samples" of docs/time_server.md: when samples were taken, by the log of
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
WIDENING = 1e-4  # H2: so much each way, for each second between a sample and its line


class Run:
    """The certified lines of a stream between two cuts: one clock told all of them."""

    def __init__(self, begin_ns):
        self.begin_ns, self.end_ns, self.lines = begin_ns, math.inf, []

    def nearest(self, boot_id, lives, n):
        """The line whose counter is nearest to n; they stand in its order. None: of another life."""
        at = bisect.bisect(self.lines, n, key=lambda line: line["counter_ns"])
        beside = [line for line in self.lines[max(at - 1, 0) : at + 1]
                  if (line["boot_id"], line["lives"]) == (boot_id, lives)]
        return min(beside, key=lambda line: abs(line["counter_ns"] - n), default=None)


class Stamper:
    def __init__(self, lines):
        """`lines`: of the log, parsed, in their order, which says between which cuts each stands."""
        self.runs, self.withdrawn = {}, {}
        for line in lines:
            kind = line.get("kind") if line["event"] == "clock_event" else line.get("certainty")
            runs = self.runs.setdefault(line["stream"], []) if "stream" in line else []
            if kind in CUTS:
                for run in runs[-1:]:
                    run.end_ns = line["begin_ns"]
                runs.append(Run(line["begin_ns"]))
            elif kind == "withdrawn":
                self.withdrawn.setdefault(line["stream"], []).append((line["begin_ns"], line["end_ns"]))
            elif kind == "certified":
                runs[-1].lines.append(line)
        for stream, runs in self.runs.items():
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


def main():
    with open(sys.argv[1], encoding="utf-8") as log:
        stamper = Stamper(json.loads(line) for line in log)
    for row in sys.stdin:
        stamp = stamper.stamp(*map(int, row.split()))
        print(*stamp if stamp else ("not certified",))


if __name__ == "__main__":
    main()
