// SPDX-License-Identifier: Apache-2.0
// Errors are values that name the file and the line. A function that can fail returns Result<T>. A
// reader that can continue after a fault collects Findings.
#pragma once

#include <tl/expected.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The kind of an error, for code that prints advice. Such code compares the kind and never
/// searches the words of a message. An error about which no code gives advice has the kind `other`.
enum class ErrorKind : std::uint8_t {
  other,
  interrupted,           // the user stopped the job
  directory,             // the path names a directory instead of a file
  unreadable_disk,       // the system reports an input/output error
  no_such_file,          // reported for key files only
  exposed_key,           // other users may read the key file
  forbidden_key,         // this user may not read the key file
  port_taken,            // another program has the port
  port_forbidden,        // this user may not open the port
  address_elsewhere,     // this machine has no network interface with the address
  lost_process,          // another process of the same training ended and reports the reason
  no_such_joint,         // an option names a joint that the stream does not have
  no_such_node,          // an option names a node that the stream does not have
  too_few_joints,        // a fit needs more named joints
  no_common_span,        // the streams do not overlap in time
  no_rows_in_recording,  // a recording has no device, or no rows for this stream
};
/// The largest kind. A process that reads HDF5 files (formats/take/guarded.h) sends kinds as
/// numbers. The receiver checks the numbers against this limit.
inline constexpr ErrorKind last_error_kind = ErrorKind::no_rows_in_recording;

/// An error, worded for the person who has to repair the file.
struct Error {
  std::string file;       // name as given by the user; empty if there is no file
  std::int64_t line = 0;  // counted from 1; 0 for binary files, whose byte offset is in `found`
  std::string expected;   // for example "three numbers after OFFSET"
  std::string found;      // for example "two", or the text of the file, see shown()
  ErrorKind kind = ErrorKind::other;  // for advice; the message does not contain it
};

/// The message, for example "walk.bvh:12: expected 2 frames, found 1".
std::string to_string(const Error& error);

/// Text from a file or from a network in a form that a message may show: at most 40 bytes, without
/// control characters and without line ends.
std::string shown(std::string_view text);

/// For map_error() of a Result: sets the error's file to `file` if the error has none.
inline auto in_file(std::string file) {
  return [file = std::move(file)](Error error) {
    if (error.file.empty()) error.file = file;
    return error;
  };
}

/// Makes text safe for a terminal. The result is UTF-8. Invalid bytes and all control characters
/// except line ends become '?', including U+0080 to U+009F and the characters that change the
/// writing direction.
std::string harmless(std::string_view text);

enum class Severity { note, warning, error };

/// A fault in an input that could be read nevertheless.
struct Finding {
  Severity severity = Severity::warning;
  Error what;
  std::string meaning;  // the consequence for the result, such as "the last frame was dropped"
  std::string repair;   // advice for the user; empty if nothing needs to be done
};

using Findings = std::vector<Finding>;

inline void append(Findings& all, const Findings& more) {
  all.insert(all.end(), more.begin(), more.end());
}

inline void add_warning(Findings& all, Error what, std::string meaning, std::string repair = {}) {
  all.push_back({Severity::warning, std::move(what), std::move(meaning), std::move(repair)});
}
inline void add_note(Findings& all, Error what, std::string meaning, std::string repair = {}) {
  all.push_back({Severity::note, std::move(what), std::move(meaning), std::move(repair)});
}
/// Collects findings about one file.
struct FileFindings {
  std::string file;
  Findings all{};

  void add(Severity severity, std::string expected, std::string found, std::string meaning,
           std::string repair = "") {
    all.push_back({severity, Error{file, 0, std::move(expected), std::move(found)},
                   std::move(meaning), std::move(repair)});
  }
};

/// The severity's word in messages and in JSON, for example "warning".
std::string_view to_string(Severity severity);

/// A value, or the Error that prevented it. Exceptions of libraries are caught in the file that
/// calls the library, so callers only check Results.
template <class T>
using Result = tl::expected<T, Error>;  // C++23: std::expected
using Failure = tl::unexpected<Error>;

/// A failure that concerns a whole file, so it has no line.
inline Failure refuse(std::string_view file, std::string expected, std::string found) {
  return Failure(Error{std::string(file), 0, std::move(expected), std::move(found)});
}
/// A failure without a file. The caller adds the file.
inline Failure refuse(std::string expected, std::string found) {
  return refuse("", std::move(expected), std::move(found));
}

/// Returns the value for KA_TRY. KA_TRY can't dereference a Result<void>, which has no value.
template <class T>
T unwrap(Result<T>&& result) {
  if constexpr (!std::is_void_v<T>) return *std::move(result);
}

}  // namespace kinalign

/// Gives the value of a Result, or returns its error from the calling function. Uses may be nested,
/// because each use has its own variable name.
#define KA_TRY(expression) KA_TRY_AS(KA_TRY_JOIN(ka_result_, __COUNTER__), expression)
#define KA_TRY_JOIN(a, b) KA_TRY_JOINED(a, b)
#define KA_TRY_JOINED(a, b) a##b
// This is a statement expression of GCC and Clang. Its value is the value of its last statement.
#define KA_TRY_AS(result, expression)                                     \
  __extension__({                                                         \
    auto result((expression));                                            \
    if (!(result)) return ::kinalign::Failure(std::move(result).error()); \
    ::kinalign::unwrap(std::move(result));                                \
  })
