# SPDX-License-Identifier: Apache-2.0
"""Takes that together have the counts of the paper's tables 6 and 7, person by person and class by class.

The paper gives the sums of both tables alone. Which person did what is ours: the first that goes together with both.
"""
import itertools

# Paper, table 6: people of one sex and height; frames of mocap, Kinect, IMU.
PEOPLE = [(("09",), "f", 155, 132_948, 132_948, 132_948), (("10",), "f", 160, 43_034, 13_258, 43_034),
          (("05",), "f", 165, 179_902, 179_902, 0), (("07",), "f", 170, 33_680, 33_680, 0),
          (("04",), "m", 170, 171_231, 171_231, 171_231),
          (("00", "03", "06", "11"), "m", 175, 1_860_469, 1_860_469, 335_640),
          (("01", "02", "08"), "m", 180, 540_317, 540_317, 395_329)]
# Paper, table 7.
CLASSES = [("S1", 621_208, 621_208, 129_944), ("S2", 659_291, 629_515, 583_859), ("S3", 764_570, 764_570, 272_335),
           ("S4", 179_902, 179_902, 0), ("S5", 702_930, 702_930, 92_044), ("S6", 33_680, 33_680, 0)]
ACTIONS = {"S1": 8, "S2": 8, "S3": 5, "S4": 5, "S5": 6, "S6": 2}  # of the template


def transport(supplies, demands):
    """Amounts from each supply to each demand whose sums are these (north-west corner)."""
    supplies, demands, out = dict(supplies), dict(demands), {}
    for who, what in itertools.product(list(supplies), list(demands)):
        amount = min(supplies[who], demands[what])
        if amount > 0:
            out[who, what] = amount
            supplies[who] -= amount
            demands[what] -= amount
    assert not any(supplies.values()) and not any(demands.values()), (supplies, demands)
    return out


def cells():
    """(group of people, class, with Kinect, with IMU) and frames."""
    rest = {"05": "S4", "07": "S6"}  # who alone has all of a class
    without_kinect = 29_776  # person 10, class S2
    all_three = transport(
        {i: imu - (without_kinect if ids == ("10",) else 0) for i, (ids, _, _, _, _, imu) in enumerate(PEOPLE)},
        {name: imu - (without_kinect if name == "S2" else 0) for name, _, _, imu in CLASSES})
    pairs = transport(
        {i: kinect - sum(n for (who, _), n in all_three.items() if who == i)
         for i, (ids, _, _, _, kinect, _) in enumerate(PEOPLE) if ids[0] not in rest},
        {name: kinect - sum(n for (_, what), n in all_three.items() if what == name)
         for name, _, kinect, _ in CLASSES if name not in rest.values()})
    yield from ((who, what, True, True, n) for (who, what), n in all_three.items())
    yield from ((who, what, True, False, n) for (who, what), n in pairs.items())
    for i, (ids, _, _, mocap, _, _) in enumerate(PEOPLE):
        if ids[0] in rest:
            yield i, rest[ids[0]], True, False, mocap
        if ids == ("10",):
            yield i, "S2", False, True, without_kinect


def composition(divisor=1, longest=8_000):
    """Takes of at most `longest` frames: (subject, action, frames, with Kinect, with IMU)."""
    takes, people, actions = [], {}, {}
    for who, what, kinect, imu, frames in cells():
        left = frames // divisor
        while left > 0:
            count = -(-left // longest)
            part = -(-left // count)
            left -= part
            ids = people.setdefault(who, itertools.cycle(PEOPLE[who][0]))
            number = actions.setdefault(what, itertools.cycle(range(1, ACTIONS[what] + 1)))
            takes.append((next(ids), f"{what}A{next(number):02}", part, kinect, imu))
    return takes


def sums(takes, key):
    """Frames of mocap, Kinect and IMU by what `key` says of a take."""
    out = {}
    for take in takes:
        _, _, frames, kinect, imu = take
        row = out.setdefault(key(take), [0, 0, 0])
        row[0] += frames
        row[1] += frames * kinect
        row[2] += frames * imu
    return out


def without(manifest, stream):
    """Takes a stream out of a manifest."""
    parts = manifest.read_text().split("\n[")
    manifest.write_text("\n[".join(p for p in parts if not p.startswith((f"stream.{stream}", f"space.{stream}"))))


if __name__ == "__main__":
    whole = composition()
    heights = {person: (sex, height) for ids, sex, height, *_ in PEOPLE for person in ids}
    by_person = sums(whole, lambda take: heights[take[0]])
    assert by_person == {(sex, height): list(rest) for _, sex, height, *rest in PEOPLE}, by_person
    assert sums(whole, lambda take: take[1][:2]) == {name: list(rest) for name, *rest in CLASSES}
    print(len(whole), "takes,", sum(sum(row) for row in by_person.values()), "frames; both tables hold")
