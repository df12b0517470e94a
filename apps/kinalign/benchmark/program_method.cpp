// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/program_method.h"

#include "apps/cli/child_process.h"

#include "kinalign/formats/take/take_npz.h"
#include "kinalign/models/windows_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace kinalign {

namespace {

/// A larger answer of a program is refused.
constexpr std::size_t most_answer_bytes = std::size_t{1} << 30U;

/// The bytes of the values. The machine must be little-endian, since the NPZ types such as "<f4"
/// mean little-endian numbers.
template <class T>
std::string_view bytes_of_values(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Writes the input of a program: positions, seen, joint_names, output_names, rate_hz.
Result<void> write_question(const CleaningData& data, const Pair& pair, const std::string& path,
                            Call& call) {
  const std::uint64_t frames = pair.input.frames(), joints = pair.input.joints;
  const NpzTexts inputs = npz_texts("joint_names", data.layout.inputs),
                 outputs = npz_texts("output_names", data.layout.outputs);
  const std::vector<double> rate{data.layout.rate_hz};
  // The arrays are appended in the order in which create() lists them.
  NpzWriter writer =
      KA_TRY(NpzWriter::create(call.surroundings.files, path, Overwrite::yes,
                               {npz_numbers("positions", Stored::float32, {frames, joints, 3}),
                                npz_numbers("seen", Stored::uint8, {frames, joints}), inputs.array,
                                outputs.array, npz_numbers("rate_hz", Stored::float64, {1})}));
  KA_TRY(writer.append(0, bytes_of_values(pair.input.positions)));
  KA_TRY(writer.append(1, bytes_of_values(pair.input.seen)));
  KA_TRY(writer.append(2, inputs.bytes));
  KA_TRY(writer.append(3, outputs.bytes));
  KA_TRY(writer.append(4, bytes_of_values(rate)));
  return writer.finish();
}

/// Reads "positions" from the NPZ of a program. Fails if the array has another shape or contains
/// NaN or infinity.
Result<std::vector<float>> read_answer(const std::string& path, std::size_t frames,
                                       std::size_t joints, Call& call) {
  const std::string bytes = KA_TRY(read_whole(call.surroundings.files, path, most_answer_bytes));
  const auto arrays = KA_TRY(stored_arrays(bytes, path));
  const auto positions = arrays.find("positions");
  // The program must give a position for each frame of the stretch and each joint in output_names.
  const std::vector<std::uint64_t> shape{frames, joints, 3};
  if (positions != arrays.end() && positions->second.header.shape == shape &&
      positions->second.header.kind == 'f') {
    std::vector<float> out(3 * frames * joints);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = static_cast<float>(number_at(positions->second, i));
    }
    const auto is_number = [](float value) { return std::isfinite(value); };
    if (std::all_of(out.begin(), out.end(), is_number)) return out;
  }
  return Failure(Error{
      path, 0, fmt::format("\"positions\" [{},{},3] of finite float32 or float64", frames, joints),
      "another shape, type or value"});
}

}  // namespace

Result<ProgramMethod> program_method(const std::string& words) {
  const std::size_t equals = words.find('=');
  const std::string name = words.substr(0, equals);
  // The name becomes a folder and a row of the table, so it must not contain '/' or spaces.
  const auto is_fit = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
  if (equals == std::string::npos || name.empty() || equals + 1 == words.size() ||
      !std::all_of(name.begin(), name.end(), is_fit)) {
    return Failure(Error{"--method", 0, "NAME=PROGRAM, such as mine=./mine.py", shown(words)});
  }
  return ProgramMethod{name, words.substr(equals + 1)};
}

Result<std::vector<std::vector<float>>> answers_of_program(const ProgramMethod& method,
                                                           const std::string& folder,
                                                           const CleaningData& data, Call& call) {
  const std::string below = folder + "/programs/" + method.name;
  KA_TRY(make_folders(below));
  std::vector<std::vector<float>> out;
  std::error_code ignored;
  for (const Pair* pair : data.tested) {
    const std::string question = below + "/input.npz", answer = below + "/output.npz";
    // The old answer is removed: if the program writes nothing, the answer to the previous stretch
    // must not be read.
    std::filesystem::remove(answer, ignored);
    KA_TRY(write_question(data, *pair, question, call));
    // The program's stdout goes to stderr, because stdout is for --json.
    const int code = wait_for_child(
        KA_TRY(start_child(method.program, {method.program, question, answer}, 2, 2)));
    if (code != 0) {
      return Failure(Error{method.program, 0, "exit code 0 for " + pair->take,
                           fmt::format("exit code {}", code)});
    }
    out.push_back(
        KA_TRY(read_answer(answer, pair->input.frames(), data.layout.outputs.size(), call)));
  }
  std::filesystem::remove_all(below, ignored);
  std::filesystem::remove(folder + "/programs", ignored);  // works only if the folder is empty
  return out;
}

}  // namespace kinalign
