# SPDX-License-Identifier: Apache-2.0
"""Simulated people for cases of pose and fuse."""
import json

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
