#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""UI-PRMD's aligned pairs for kinalign_kinect_table: the protocol's own alignment, written plainly.

    /usr/bin/python3 tools/kinect_table/export_ui_prmd.py OUT.bin

The protocol (../shared/tools/ui_prmd_marks.py) finds joint centres, shift and transform; here is
only the file. Little-endian: 8 bytes "KAPAIRS1", uint32 pieces; then per piece four uint32 (person,
movement, repetition, frames F), float32 Kinect [F,18,3] m and truth [F,18,3] m in the space of the
data (x person's left, y up, z towards the camera), uint8 valid [F,18]. Needs NumPy and SciPy.
"""
import pathlib
import sys

import numpy as np

SHARED = pathlib.Path(__file__).resolve().parents[2] / '../shared'


def main():
    shared = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else SHARED
    sys.path.insert(0, str(shared / 'tools'))
    import ui_prmd_marks as marks  # pylint: disable=import-error,import-outside-toplevel

    kept = marks.align(marks.load(str(shared / 'data/ui_prmd')))
    kept.sort(key=lambda r: (r['person'], r['movement'], r['repetition']))
    with open(sys.argv[1], 'wb') as out:
        out.write(b'KAPAIRS1' + np.uint32(len(kept)).tobytes())
        for r in kept:
            head = [r['person'], r['movement'], r['repetition'], len(r['x'])]
            out.write(np.array(head, '<u4').tobytes())
            out.write((r['x'] / 100).astype('<f4').tobytes())
            out.write((r['y'] / 100).astype('<f4').tobytes())
            out.write(r['w'].astype('u1').tobytes())
    print(f'{len(kept)} repetitions, {sum(len(r["x"]) for r in kept)} frames')


if __name__ == '__main__':
    main()
