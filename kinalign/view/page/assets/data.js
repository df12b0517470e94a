// The page's data: JSON in the element #take. Long series in it are packed
// (kinalign/view/page/packed_series.h).
// SPDX-License-Identifier: Apache-2.0

const blockRows = 256, mostZeros = 20, allZero = 31;

/// Reads bits from the highest to the lowest of each byte.
class BitReader {
  constructor(text) {
    const bytes = atob(text);
    this.bytes = new Uint8Array(bytes.length + 8);
    for (let i = 0; i < bytes.length; ++i) this.bytes[i] = bytes.charCodeAt(i);
    this.at = 0;
  }
  /// Returns the next 32 bits without moving the position.
  peek() {
    const b = this.bytes, i = this.at >> 3, shift = this.at & 7;
    const high = ((b[i] << 24) | (b[i + 1] << 16) | (b[i + 2] << 8) | b[i + 3]) << shift;
    return (high | (b[i + 4] >> (8 - shift))) >>> 0;
  }
  bits(count) {
    if (count === 0) return 0;
    const value = this.peek() >>> (32 - count);
    this.at += count;
    return value;
  }
  number(k) {
    const zeros = Math.clz32(this.peek());
    if (zeros >= mostZeros) {
      this.at += mostZeros;
      return this.bits(32);
    }
    this.at += zeros + 1;
    return ((zeros << k) | this.bits(k)) >>> 0;
  }
}

/// Returns a packed series [rows, columns] as numbers, row after row.
export function unpacked(series) {
  const { rows, columns, step, packed } = series;
  const out = new Float32Array(rows * columns);
  const reader = new BitReader(packed);
  for (let c = 0; c < columns; ++c) {
    let last = 0, before = 0;
    for (let first = 0; first < rows; first += blockRows) {
      const order = reader.bits(2), k = reader.bits(5), end = Math.min(first + blockRows, rows);
      for (let r = first; r < end; ++r) {
        const u = k === allZero ? 0 : reader.number(k);
        let x = u & 1 ? -((u + 1) / 2) : u / 2;
        if (order === 1) x += last;
        if (order === 2) x += 2 * last - before;
        before = last;
        last = x;
        out[r * columns + c] = x * step;
      }
    }
  }
  return out;
}

const isSeries = (value) => value !== null && typeof value === "object" && "packed" in value;

/// Replaces each packed series in the data by its numbers.
function unpackAll(value) {
  for (const key of Object.keys(value)) {
    if (isSeries(value[key])) value[key] = unpacked(value[key]);
    else if (value[key] !== null && typeof value[key] === "object") unpackAll(value[key]);
  }
}

export function readTake() {
  const take = JSON.parse(document.getElementById("take").textContent);
  unpackAll(take);
  take.rows = take.seconds.length;
  for (const body of take.bodies) body.joints = body.joint_names.length;
  return take;
}

/// Returns the index of the last element of rising `times` that is not after `t`; 0 before the
/// first.
export function rowAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

export function place(body, row, joint) {
  const i = 3 * (row * body.joints + joint);
  return [body.positions[i], body.positions[i + 1], body.positions[i + 2]];
}

/// Returns the position at `share` of the way to the next row, if the joint is visible in both
/// rows.
export function placeBetween(body, row, joint, share) {
  const here = place(body, row, joint);
  if (share === 0 || stateOf(body, row, joint) === 0 || stateOf(body, row + 1, joint) === 0) return here;
  const next = place(body, row + 1, joint);
  return here.map((v, k) => v + share * (next[k] - v));
}

/// Returns the state of a joint: 0 missing, 1 inferred, 2 tracked.
export function stateOf(body, row, joint) {
  return body.state[row * body.joints + joint];
}

export function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Rotates v by the rotation q = w,x,y,z.
export function turned(q, v) {
  const [w, x, y, z] = q;
  const tx = 2 * (y * v[2] - z * v[1]), ty = 2 * (z * v[0] - x * v[2]), tz = 2 * (x * v[1] - y * v[0]);
  return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx];
}

/// Undoes the transform of a moved stream. Returns the point in the stream's own space.
export function beforeMove(space, point) {
  const [w, x, y, z] = space.rotation, t = space.translation;
  return turned([w, -x, -y, -z], [point[0] - t[0], point[1] - t[1], point[2] - t[2]]);
}
