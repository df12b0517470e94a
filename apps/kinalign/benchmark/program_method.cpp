// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/program_method.h"

#include "apps/cli/console.h"

#include "kinalign/formats/take/take_npz.h"
#include "kinalign/models/windows_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace kinalign {

namespace {

/// A larger answer is refused.
constexpr std::size_t most_answer_bytes = std::size_t{1} << 30U;

/// The values as bytes in the machine's order. NPZ type names such as "<f4" promise little-endian
/// numbers.
template <class T>
std::string_view bytes_of_values(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Writes the program's input: positions, seen, joint_names, output_names, rate_hz.
Result<void> write_question(const CleaningData& data, const Pair& pair, const std::string& path,
                            Call& call) {
  const std::uint64_t frames = pair.input.frames(), joints = pair.input.joints;
  const NpzTexts inputs = npz_texts("joint_names", data.layout.inputs),
                 outputs = npz_texts("output_names", data.layout.outputs);
  const std::vector<double> rate{data.layout.rate_hz};
  // The arrays are appended in the order in which they were declared.
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

/// Runs the program and returns its exit code. Its output goes to stderr.
/// Standard input is /dev/null, so a program that asks a question ends instead of waiting. Standard
/// output goes to stderr, since --json owns stdout.
Result<int> run_program_on(const std::string& program, std::string question, std::string answer) {
  std::string name = program;
  const std::array<char*, 4> words{name.data(), question.data(), answer.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  // The child's descriptor 1 becomes a copy of its descriptor 2.
  ::posix_spawn_file_actions_adddup2(&actions, 2, 1);
  pid_t child = 0;
  const int fault =
      ::posix_spawnp(&child, program.c_str(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (fault != 0) {
    return Failure(Error{program, 0, "a program that can be started", std::strerror(fault)});
  }
  int status = 0;
  // A signal to this process may interrupt waiting; the child goes on.
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  // A shell reports a death by signal N as 128 + N, too.
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Reads "positions" from the program's NPZ. Fails for another shape and for numbers that are not
/// finite.
Result<std::vector<float>> read_answer(const std::string& path, std::size_t frames,
                                       std::size_t joints, Call& call) {
  const std::string bytes = KA_TRY(read_whole(call.surroundings.files, path, most_answer_bytes));
  const auto arrays = KA_TRY(stored_arrays(bytes, path));
  const auto positions = arrays.find("positions");
  // The program must answer each frame of the stretch for each joint in output_names.
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
  // The name becomes a folder and a row of the table, so it may contain no '/' and no space.
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
    // An answer of the stretch before would be taken for this one if the program wrote nothing.
    std::filesystem::remove(answer, ignored);
    KA_TRY(write_question(data, *pair, question, call));
    const int code = KA_TRY(run_program_on(method.program, question, answer));
    if (code != 0) {
      return Failure(Error{method.program, 0, "exit code 0 for " + pair->take,
                           fmt::format("exit code {}", code)});
    }
    out.push_back(
        KA_TRY(read_answer(answer, pair->input.frames(), data.layout.outputs.size(), call)));
  }
  std::filesystem::remove_all(below, ignored);
  std::filesystem::remove(folder + "/programs", ignored);  // only if it is empty
  return out;
}

}  // namespace kinalign
