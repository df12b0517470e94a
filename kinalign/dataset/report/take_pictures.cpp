// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/take_pictures.h"

#include "kinalign/dataset/summarise.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/view/page/body_figures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// The rows are tried at these eighths of the take's length, from the middle outwards.
constexpr std::array<std::uint64_t, 7> eighths{4, 3, 5, 2, 6, 1, 7};
constexpr std::size_t most_joints = 1000;

/// The bodies in one row of a take, and the number of tracked joints, by which rows are compared.
struct RowOfBodies {
  std::vector<PageBody> bodies;
  std::size_t tracked = 0;  // joints of all bodies
  bool is_whole = true;     // all joints of all bodies are tracked
};

/// The bodies of one row, with the number of their tracked joints.
RowOfBodies bodies_of(const TakeHeader& header, const TakeSlab& slab) {
  RowOfBodies out;
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    // Streams of nodes have no positions to draw.
    if (std::holds_alternative<ImuGroup>(header.groups[g].kind)) continue;
    // Each stream with joints gives one body.
    BodyFigures figures(header.groups[g], out.bodies.size());
    figures.add(slab.rows[g], 0, true);
    PageBody body = figures.take_body();
    const auto tracked = std::count(body.state.begin(), body.state.end(),
                                    static_cast<std::uint8_t>(Tracking::tracked));
    out.tracked += static_cast<std::size_t>(tracked);
    out.is_whole = out.is_whole && static_cast<std::size_t>(tracked) == body.state.size();
    out.bodies.push_back(std::move(body));
  }
  return out;
}

/// The row with the most tracked joints among seven of the take.
Result<std::string> typical_row(TakeReader& reader) {
  const TakeHeader& header = reader.header();
  RowOfBodies best;
  TakeSlab slab;
  for (const std::uint64_t eighth : eighths) {
    if (header.frames == 0) break;
    // The row at this eighth of the take.
    KA_TRY(reader.read(std::min(header.frames / 8 * eighth, header.frames - 1), 1, slab));
    RowOfBodies row = bodies_of(header, slab);
    // If several rows are equal, the first one is kept, because it is nearest to the middle.
    if (best.bodies.empty() || row.tracked > best.tracked) best = std::move(row);
    if (best.is_whole) break;
  }
  return bodies_json(best.bodies);
}

/// A body from the text of a child process.
PageBody body_from(const Json& json) {
  PageBody body;
  // Colours are written as 0 and 1 by bodies_json().
  const int colour = json.at("colour").get<int>();
  body.colour = colour == 0 ? PageColour::mocap : PageColour::kinect;
  body.in_take_space = json.at("in_take_space").get<bool>();
  body.parents = json.at("parents").get<std::vector<int>>();
  body.positions = json.at("positions").get<std::vector<float>>();
  body.state = json.at("state").get<std::vector<std::uint8_t>>();
  return body;
}

/// True if the lengths of the arrays fit together, and parents and states are in range. Otherwise
/// drawing would read outside of the arrays.
bool fits(const PageBody& body) {
  const std::size_t joints = body.parents.size();
  // With this limit a damaged take can't make the page too large.
  return joints <= most_joints && body.positions.size() == 3 * joints &&
         body.state.size() == joints &&
         std::all_of(body.state.begin(), body.state.end(), [](std::uint8_t s) { return s <= 2; }) &&
         std::all_of(body.parents.begin(), body.parents.end(),
                     [joints](int p) { return p >= -1 && p < static_cast<int>(joints); });
}

}  // namespace

std::string bodies_json(const std::vector<PageBody>& bodies) {
  Json out = Json::array();
  for (const PageBody& body : bodies) {
    out.push_back({{"colour", body.colour == PageColour::mocap ? 0 : 1},
                   {"in_take_space", body.in_take_space},
                   {"parents", body.parents},
                   {"positions", body.positions},
                   {"state", body.state}});
  }
  return out.dump();
}

/// Bodies whose arrays do not fit together are left out, because a damaged take may have crashed
/// the child process.
std::vector<PageBody> parse_bodies_json(std::string_view json) {
  std::vector<PageBody> out;
  try {
    for (const Json& one : Json::parse(json)) {
      PageBody body = body_from(one);
      if (fits(body)) out.push_back(std::move(body));
    }
  } catch (const Json::exception&) {
    out.clear();
  }
  return out;
}

std::vector<std::vector<PageBody>> typical_rows(FileSystem& files, const std::string& folder,
                                                const std::vector<TakeName>& names) {
  std::vector<std::vector<PageBody>> out;
  // The results come in the order of the names.
  for (const auto& text : ask_takes(files, folder, names, typical_row)) {
    out.push_back(text ? parse_bodies_json(*text) : std::vector<PageBody>{});
  }
  return out;
}

}  // namespace kinalign
