// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/windows/window_rows.h"

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/stamps.h"
#include "kinalign/take/row_arrays.h"

#include <algorithm>
#include <numeric>

namespace kinalign {

namespace {

/// The place of a window's row between two rows of the take.
struct Between {
  std::size_t row = 0;  // index of the take's last row that is not after this time
  double share = 0.0;   // 0 at that row, 1 at the next row
};

/// Finds, for each row of the window, the take's row before it and the share of the way to the next
/// row.
std::vector<Between> between(const std::vector<Time>& stamps, const WindowPlace& place,
                             double rate_hz) {
  std::vector<Between> out;
  std::size_t row = 0;
  for (std::uint64_t i = 0; i < place.rows; ++i) {
    const Time at = grid_stamp(place.begin, rate_hz, i);
    // Stamps rise, so the search continues from the row found last.
    while (row + 1 < stamps.size() && stamps[row + 1] <= at) ++row;
    double share = 0.0;
    if (row + 1 < stamps.size()) {
      share = std::chrono::duration<double>(at - stamps[row]) /
              std::chrono::duration<double>(stamps[row + 1] - stamps[row]);
    }
    out.push_back({row, std::clamp(share, 0.0, 1.0)});
  }
  return out;
}

/// True for arrays of rotations, whose components can't be interpolated separately.
bool is_rotation(std::string_view name) {
  return name == "orientation" || name == "local_rotations";
}

/// A function that interpolates `width` values between the take's row at `from` and the next row.
using Blend = void (*)(const double* from, std::size_t width, double share, double* to);

/// Interpolates vectors on the straight line between both rows.
void on_line(const double* from, std::size_t width, double share, double* to) {
  for (std::size_t k = 0; k < width; ++k) to[k] = from[k] + share * (from[width + k] - from[k]);
}

/// Interpolates rotations on the shorter arc between both rows.
void on_arc(const double* from, std::size_t width, double share, double* to) {
  const std::span<const double> one(from, width), next(from + width, width);
  const std::span<double> out(to, width);
  for (std::size_t j = 0; j < width / 4; ++j) {
    const Quat a = quat(one, j), b = quat(next, j);
    // A rotation of an invalid sample is zeros, and can't be interpolated.
    put_quat(out, j, a.norm() > 0.5 && b.norm() > 0.5 ? a.slerp(share, b).normalized() : a);
  }
}

/// Interpolates all rows of one array.
void blend(std::string_view name, const std::vector<Between>& rows, std::size_t width,
           const std::vector<double>& from, std::vector<double>& to) {
  const Blend make = is_rotation(name) ? on_arc : on_line;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double* at = from.data() + rows[i].row * width;
    if (rows[i].share == 0.0) {
      std::copy_n(at, width, to.data() + i * width);
    } else {
      make(at, width, rows[i].share, to.data() + i * width);
    }
  }
}

/// The uncertainty between two rows is that of the row with the larger one; -1: not known.
std::int64_t worse(std::int64_t a, std::int64_t b) {
  return std::min(a, b) < 0 ? -1 : std::max(a, b);
}
template <class Flag>
Flag worse(Flag a, Flag b) {
  return std::min(a, b);
}

template <class Value>
void blend(std::string_view, const std::vector<Between>& rows, std::size_t width,
           const std::vector<Value>& from, std::vector<Value>& to) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Value* at = from.data() + rows[i].row * width;
    for (std::size_t k = 0; k < width; ++k) {
      to[i * width + k] = rows[i].share == 0.0 ? at[k] : worse(at[k], at[width + k]);
    }
  }
}

/// Calls use(name, array of `from`, array of `to`) for each array of two streams of the same kind.
template <class Rows, class Use>
void for_each_pair(const Rows& from, Rows& to, Use&& use) {
  // Both streams have the same arrays in the same order.
  for_each_column<Rows>([&](std::string_view name, auto of) { use(name, of(from), of(to)); });
}

/// Sets invalid cells to zero, as they are in a take. Invalid rows of a skeleton keep their pose.
void clear_invalid(std::vector<double>& values, const std::vector<std::uint8_t>& valid) {
  if (values.empty()) return;
  const std::size_t width = values.size() / valid.size();
  for (std::size_t cell = 0; cell < valid.size(); ++cell) {
    if (valid[cell] == 0)
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(cell * width), width, 0.0);
  }
}
void clear_invalid(ClipRows&) {}
void clear_invalid(PointRows& rows) { clear_invalid(rows.positions, rows.valid); }
void clear_invalid(ImuRows& rows) {
  for (auto* values : {&rows.orientation, &rows.acceleration, &rows.angular_velocity}) {
    clear_invalid(*values, rows.valid);
  }
}

/// Fills the window with rows at its own rate, interpolated between the take's rows.
void resample(const TakeSlab& raw, const WindowPlace& place, double rate_hz, TakeSlab& out) {
  const std::vector<Between> rows = between(raw.stamps, place, rate_hz);
  out.stamps.clear();
  for (std::uint64_t i = 0; i < place.rows; ++i) {
    out.stamps.push_back(grid_stamp(place.begin, rate_hz, i));
  }
  // The copy gives `out` the right kinds of rows. Its arrays are overwritten below.
  out.rows = raw.rows;
  for (std::size_t g = 0; g < raw.rows.size(); ++g) {
    std::visit(
        [&](auto& to) {
          const auto& from = std::get<std::decay_t<decltype(to)>>(raw.rows[g]);
          for_each_pair(from, to, [&](std::string_view name, const auto& one, auto& other) {
            const std::size_t width = one.size() / raw.stamps.size();
            other.resize(rows.size() * width);
            blend(name, rows, width, one, other);
          });
          clear_invalid(to);
        },
        out.rows[g]);
  }
}

/// Repeats the last row until there are `length` rows.
template <class Value>
void pad(std::vector<Value>& values, std::size_t rows, std::size_t length) {
  // An array that the stream does not have is empty and stays empty.
  const std::size_t width = values.size() / rows;
  const std::vector<Value> last(values.end() - static_cast<std::ptrdiff_t>(width), values.end());
  for (std::size_t i = rows; i < length; ++i) values.insert(values.end(), last.begin(), last.end());
}

/// Extends a window to its full length. The added rows are invalid.
void pad(TakeSlab& slab, std::size_t length) {
  const std::size_t rows = slab.stamps.size();
  for (auto& stream : slab.rows) {
    std::visit(
        [&](auto& one) {
          using Rows = std::decay_t<decltype(one)>;
          if constexpr (std::is_same_v<Rows, ClipRows>) {
            // A stream without valid flags is valid everywhere. It gets flags now, because the
            // added rows are invalid.
            if (one.valid.empty()) one.valid.assign(rows, 1);
          }
          // The flags are first repeated like all arrays. Those of the added rows are then cleared.
          const std::size_t cells = one.valid.size();
          for_each_column<Rows>([&](std::string_view, auto of) { pad(of(one), rows, length); });
          std::fill(one.valid.begin() + static_cast<std::ptrdiff_t>(cells), one.valid.end(),
                    std::uint8_t{0});
        },
        stream);
  }
  pad(slab.stamps, rows, length);
}

}  // namespace

Result<void> read_window(TakeReader& reader, const WindowPlace& place, const WindowGrid& grid,
                         TakeSlab& raw, TakeSlab& out) {
  if (grid.rate_hz <= 0.0) {
    // The window has the take's own rows, so they are read straight into it.
    KA_TRY(reader.read(place.first, place.take_rows, out));
  } else {
    KA_TRY(reader.read(place.first, place.take_rows, raw));
    resample(raw, place, grid.rate_hz, out);
  }
  out.first = place.first;
  if (place.rows < grid.length) pad(out, grid.length);
  return {};
}

double valid_share(const TakeSlab& window, std::size_t stream, std::uint64_t rows) {
  return std::visit(
      [&](const auto& one) {
        // A stream without valid flags is valid everywhere.
        if (one.valid.empty()) return 1.0;
        const auto cells = one.valid.size() / window.stamps.size() * rows;
        const auto sum = std::accumulate(one.valid.begin(), one.valid.end(), std::uint64_t{0});
        return static_cast<double>(sum) / static_cast<double>(cells);
      },
      window.rows[stream]);
}

}  // namespace kinalign
