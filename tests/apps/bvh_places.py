# SPDX-License-Identifier: Apache-2.0
"""Where the joints of a BVH lie: an independent witness of kinematics, in NumPy alone."""
import numpy


def turns(axis, degrees):
    """Rotations [T,3,3] about an axis, right-handed."""
    first, second = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[axis]
    out = numpy.tile(numpy.eye(3), (len(degrees), 1, 1))
    cosine, sine = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    out[:, first, first] = out[:, second, second] = cosine
    out[:, first, second], out[:, second, first] = -sine, sine
    return out


def bvh_places(path):
    """Names, and positions [T,J,3] m of a file in centimetres."""
    names, parents, offsets, channels, above, joint = [], [], [], [], [], None
    head, _, body = path.read_text().partition("MOTION\n")
    for words in map(str.split, head.splitlines()):
        if words[0] in ("ROOT", "JOINT", "End"):
            joint = len(names) if words[0] != "End" else None
            if joint is not None:
                names.append(words[1])
                parents.append(above[-1] if above else None)
        elif words[0] == "{":
            above.append(joint)
        elif words[0] == "}":
            above.pop()
        elif words[0] == "OFFSET" and above[-1] is not None:
            offsets.append(numpy.array(words[1:], float))
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
    values = numpy.array([line.split() for line in body.splitlines()[2:]], float)
    places, rotations, column = numpy.zeros((len(values), len(names), 3)), [], 0
    for j, parent in enumerate(parents):
        place = numpy.tile(offsets[j], (len(values), 1))
        turn = numpy.tile(numpy.eye(3), (len(values), 1, 1))
        for channel in channels[j]:
            if channel.endswith("position"):
                place[:, "XYZ".index(channel[0])] = values[:, column]
            else:
                turn = turn @ turns(channel[0], values[:, column])
            column += 1
        if parent is not None:
            place = places[:, parent] + numpy.einsum("tij,tj->ti", rotations[parent], place)
            turn = rotations[parent] @ turn
        places[:, j] = place
        rotations.append(turn)
    return names, places / 100
