# SPDX-License-Identifier: Apache-2.0
"""Simulated people for cases of pose and fuse."""
import json

import data_sets
import numpy
from cases import done_with

# Joints of the answer and of the simulated suit.
SAME = {"ltibia": "LeftLeg", "lfoot": "LeftFoot", "rtibia": "RightLeg", "rfoot": "RightFoot", "lradius": "LeftForeArm",
        "lhand": "LeftHand", "rradius": "RightForeArm", "rhand": "RightHand", "lhumerus": "LeftArm",
        "rhumerus": "RightArm", "head": "Head"}


def simulated(folder, seconds=30, seed=1):
    """A take of a simulated person with suit and nodes, and its manifest."""
    done_with(0, "simulate", "built-in", "-o", folder, "--seconds", seconds, "--seed", seed, "--quiet")
    done_with(0, "align", folder / "recording.toml", "-o", folder / "take.h5", "--quiet")
    return folder / "take.h5", folder / "recording.toml"


def told(*words, code=0):
    return json.loads(done_with(code, *words, "--json")[0])


# CMU's joints (ASF/AMC), parents first: parent, offset in cm.
CMU = {"root": ("", (0, 0, 0)), "lfemur": ("root", (8, -8, 3)), "ltibia": ("lfemur", (13, -36, 0)),
       "lfoot": ("ltibia", (14, -38, 0)), "ltoes": ("lfoot", (0, -5, 12)), "rfemur": ("root", (-8, -8, 3)),
       "rtibia": ("rfemur", (-13, -36, 0)), "rfoot": ("rtibia", (-14, -38, 0)), "rtoes": ("rfoot", (0, -5, 12)),
       "lowerback": ("root", (0, 5, 0)), "upperback": ("lowerback", (0, 11, 0)), "thorax": ("upperback", (0, 11, 0)),
       "lowerneck": ("thorax", (0, 12, 0)), "upperneck": ("lowerneck", (0, 9, 0)), "head": ("upperneck", (0, 9, 0)),
       "lclavicle": ("thorax", (2, 8, 0)), "lhumerus": ("lclavicle", (15, 4, 0)), "lradius": ("lhumerus", (28, 0, 0)),
       "lwrist": ("lradius", (18, 0, 0)), "lhand": ("lwrist", (9, 0, 0)), "lfingers": ("lhand", (6, 0, 0)),
       "rclavicle": ("thorax", (-2, 8, 0)), "rhumerus": ("rclavicle", (-15, 4, 0)),
       "rradius": ("rhumerus", (-28, 0, 0)), "rwrist": ("rradius", (-18, 0, 0)), "rhand": ("rwrist", (-9, 0, 0)),
       "rfingers": ("rhand", (-6, 0, 0))}


def cmu_bvh(frames, phase):
    """A person with CMU's joints who stands and moves arms and legs, 60 Hz."""
    lines = []

    def joint(name, depth):
        pad = "  " * depth
        places = "6 Xposition Yposition Zposition" if depth == 0 else "3"
        lines.extend([f"{pad}{'ROOT' if depth == 0 else 'JOINT'} {name}", f"{pad}{{",
                      f"{pad}  OFFSET {' '.join(map(str, CMU[name][1]))}",
                      f"{pad}  CHANNELS {places} Zrotation Yrotation Xrotation"])
        below = [child for child, (parent, _) in CMU.items() if parent == name]
        for child in below:
            joint(child, depth + 1)
        if not below:
            lines.extend([f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET 0 4 0", f"{pad}  }}"])
        lines.append(f"{pad}}}")
        order.append(name)

    order = []
    joint("root", 0)
    order = [line.split()[1] for line in lines if line.split()[0] in ("ROOT", "JOINT")]
    rows = []
    for t in range(frames):
        swing = numpy.sin(t / 20 + phase)
        turns = {"lhumerus": -60 + 20 * swing, "rhumerus": 60 + 20 * swing, "lfemur": -18, "rfemur": 18}
        row = ["0", "92", f"{t / 10:g}"]
        for name in order:
            row += [f"{turns.get(name, 0):.4f}", "0", f"{25 * swing if name in ('lfemur', 'rtibia') else 0:.4f}"]
        rows.append(" ".join(row))
    return "\n".join(["HIERARCHY", *lines, "MOTION", f"Frames: {frames}", "Frame Time: 0.0166667", *rows]) + "\n"


def cmu_people(folder):
    """A data set of three such persons, four seconds each: folder/set, built."""
    raw = folder / "raw"
    raw.mkdir()
    for person in (1, 2, 3):
        (raw / f"{person:02}_01.bvh").write_text(cmu_bvh(240 + person, person))
    data_sets.done("import", folder / "set", raw, code=None)
    data_sets.done("build", folder / "set", code=None)
    return folder / "set"
