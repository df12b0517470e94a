# SPDX-License-Identifier: Apache-2.0
"""Steps of a counter that no certificate sees, and whether anything could have told.

Makes the tables of docs/clock_assumptions.md. A recording that keeps a wrong certified stamp is held against a
linear program over all that the host saw in it: is there a clock without a step, within H1 to H4,
that explains every exchange? If so, no method that certifies recordings without a step can refuse
this one.

  python3 tools/clock_steps/steps.py build/dev/tools/kinalign_clock_steps
  python3 tools/clock_steps/steps.py build/dev/tools/kinalign_clock_steps --minutes 5 --links DEG

Needs SciPy.
"""
import argparse
import json
import shutil
import subprocess
import sys

import numpy
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

# kinalign/clock/assumptions.h: H2, H3.
RATE, CURVATURE = 100e-6, 5e-8
RESOLUTION = 1e-6  # of the counter, s
KNOT = 1.0  # s between changes of the clock's curvature
BIN = 0.5  # s: of the bounds in one the lowest is kept, which only helps a clock to explain them


def lowest(t, x):
    """Of each bin the lowest bound."""
    bins = (t / BIN).astype(int)
    order = numpy.lexsort((x, bins))
    _, first = numpy.unique(bins[order], return_index=True)
    return t[order][first], x[order][first]


def effects(t, knots):
    """Of offset, rate and each knot's curvature on the offset at t."""
    columns = [numpy.ones_like(t), t]
    for k in range(knots):
        within = numpy.clip(t - k * KNOT, 0.0, KNOT)
        columns.append(within**2 / 2 + within * numpy.clip(t - (k + 1) * KNOT, 0.0, None))
    return numpy.stack(columns, axis=1)


def least_violation(up, down):
    """s by which the best clock without a step breaks a bound; not positive: it explains all."""
    (tu, xu), (td, xd) = (lowest(b[:, 0], sign * (b[:, 1] - b[:, 0]))
                          for b, sign in ((up, 1.0), (down, -1.0)))
    begin, centre = min(tu.min(), td.min()), numpy.median(xu)
    tu, td, xu, xd = tu - begin, td - begin, xu - centre + RESOLUTION, xd + centre + RESOLUTION
    knots = int(numpy.ceil(max(tu.max(), td.max()) / KNOT)) + 1
    spare = numpy.ones((len(tu) + len(td), 1))
    bounds = numpy.vstack([effects(tu, knots), -effects(td, knots)])
    rates = numpy.zeros((knots + 1, knots + 3))
    rates[:, 1] = 1.0
    for k in range(knots + 1):
        rates[k, 2 : 2 + k] = KNOT
    matrix = numpy.vstack([numpy.hstack([bounds, -spare]), rates, -rates])
    right = numpy.concatenate([xu, xd, numpy.full(2 * (knots + 1), RATE)])
    # In ms, ppm and 0.01 ppm/s: a solver's tolerances are absolute.
    columns = numpy.concatenate([[1e-3, 1e-6], numpy.full(knots, 1e-8), [1e-3]])
    rows = numpy.concatenate([numpy.full(len(spare), 1e-3), numpy.full(2 * (knots + 1), 1e-6)])
    target = numpy.zeros(knots + 3)
    target[-1] = 1.0
    found = linprog(target, A_ub=csr_matrix(matrix * columns / rows[:, None]), b_ub=right / rows,
                    bounds=[(None, None)] * 2 + [(-CURVATURE / 1e-8, CURVATURE / 1e-8)] * knots
                    + [(-1e3, None)], method="highs")
    if not found.success:
        raise RuntimeError(found.message)
    return found.x[-1] * 1e-3


def judged(program, minutes, seeds, first, links, times):
    """What the program says, a wrong recording with its `violation`."""
    if not shutil.which(program):
        sys.exit(f"steps.py: {program}: expected kinalign_clock_steps, found no such program\n"
                 "  ./dev build makes it, as build/dev/tools/kinalign_clock_steps")
    words = [str(word) for word in (program, minutes, seeds, first, links, *times)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as told:
        for line in told.stdout:
            one = json.loads(line)
            if "up" in one:
                up, down = (numpy.array(one.pop(way)) for way in ("up", "down"))
                one["violation"] = least_violation(up, down)
            yield one
    if told.returncode:
        sys.exit(told.returncode)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", help="kinalign_clock_steps")
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seeds", type=int, default=400)
    parser.add_argument("--first", type=int, default=3000, help="seed")
    parser.add_argument("--links", default="ABCDEG")
    parser.add_argument("--times", type=float, nargs="+", default=[1.0, 1.1, 1.25, 1.5, 2.0],
                        help="of both least delays together")
    wanted = parser.parse_args()
    counts, wrong = {}, []
    for one in judged(wanted.program, wanted.minutes, wanted.seeds, wanted.first, wanted.links,
                      wanted.times):
        if "violation" in one:
            wrong.append(one)
        else:
            counts[one["times"], one["link"]] = f"{one['live']} ({one['offline']})"
    print("| step / (Fu + Fd) | " + " | ".join(wanted.links) + " |")
    print("| --- |" + " --- |" * len(wanted.links))
    for times in wanted.times:
        print(f"| {times:g} | " + " | ".join(counts[times, link] for link in wanted.links) + " |")
    explained = sum(one["violation"] <= 0.0 for one in wrong)
    print(f"\nOf {len(wrong)} recordings with a wrong stamp a clock without a step explains "
          f"{explained}.")
    for one in wrong:
        if one["violation"] > 0.0:
            print(f"not explained, by {1e3 * one['violation']:.3f} ms: {one}")


if __name__ == "__main__":
    main()
