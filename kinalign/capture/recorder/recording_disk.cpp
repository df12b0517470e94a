// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recording_disk.h"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

constexpr std::string_view suffix = ".mcap";
constexpr int most_parts = 1000;  // limit on the number of the last part

std::string part_path(const std::string& path, int part) {
  if (part == 1) return path;
  return path.substr(0, path.size() - suffix.size()) + ".part" + std::to_string(part) +
         std::string(suffix);
}

/// Returns the path of the next file. If a file of that name exists, the next number is used.
Result<std::string> free_path(const std::string& path, int part) {
  for (; part <= most_parts; ++part) {
    std::string free = part_path(path, part);
    struct stat status {};
    if (part == 1 || ::lstat(free.c_str(), &status) != 0) return free;
  }
  return Failure(Error{path, 0, "at most 1000 files of one recording", "more"});
}

// The writer shares ownership of the file with a sync that may be in progress.
McapStore store_of(const std::shared_ptr<GrowingFile>& file) {
  return {[file](std::string_view bytes) { return file->append(bytes); },
          [file](std::uint64_t at, std::span<char> to) { return file->read_at(at, to); }};
}

}  // namespace

Result<RecordingDisk> RecordingDisk::open(FileSystem& files, std::string path, MakeHead head) {
  if (!path.ends_with(suffix)) return Failure(Error{path, 0, "a name that ends in .mcap", ""});
  RecordingDisk disk(files, std::move(path), std::move(head));
  KA_TRY(disk.open_part());
  return disk;
}

/// Creates the next file and writes its head. If that fails, the file is removed, since it contains
/// no sample.
Result<void> RecordingDisk::open_part() {
  // This number counts the parts. The number in the name may be higher if names are in use.
  const int part = static_cast<int>(paths_.size()) + 1;
  const std::string path = KA_TRY(free_path(path_, part));
  auto file = std::make_shared<GrowingFile>(KA_TRY(GrowingFile::create(*files_, path)));
  auto writer = std::make_unique<McapWriter>(store_of(file));
  const RecordingHead head = head_(part);
  Result<void> begun = writer->begin(head.header);
  for (const McapMetadata& metadata : head.metadata) {
    if (begun) begun = writer->write(metadata);
  }
  for (const McapAttachment& attachment : head.attachments) {
    if (begun) begun = writer->write(attachment);
  }
  if (!begun) {
    files_->remove(path.c_str());
    return begun;
  }
  file_ = std::move(file);
  writer_ = std::move(writer);
  open_ = stands_ = true;
  synced_ = 0;
  paths_.push_back(path);
  return {};
}

/// If no file is open, write() attempts to open one. The earlier failure is already reported.
Result<void> RecordingDisk::write(McapStoredChunk chunk) {
  kept_bytes_ += chunk.bytes.size();
  kept_.push_back({std::move(chunk)});
  Result<void> put = put_kept();
  return put || !open_ ? put : next_part(put.error());
}

/// Writes all chunks that the file lacks. If a new file accepts none of them, it is removed.
/// Otherwise a full disk that still creates files would collect empty files.
Result<void> RecordingDisk::put_kept() {
  const bool fresh = !open_;
  if (fresh) KA_TRY(open_part());
  for (Kept& kept : kept_) {
    if (kept.end != 0) continue;
    Result<void> written = writer_->write(kept.chunk);
    if (!written && fresh && &kept == &kept_.front()) remove_part();
    if (!written) return written;
    kept.end = file_->size();
    kept.written = true;
  }
  // The new file now has all chunks of the abandoned one.
  if (repeated_) files_->remove(std::exchange(repeated_, std::nullopt)->path.c_str());
  if (given_up_) failures_.push_back({*std::exchange(given_up_, std::nullopt), paths_.back()});
  return {};
}

void RecordingDisk::remove_part() {
  files_->remove(paths_.back().c_str());
  paths_.pop_back();
  open_ = stands_ = false;
}

/// Ends the file as well as possible. The next file will repeat all chunks in memory.
///
/// If no sync of the file succeeded and it is not the first file, the next file repeats all its
/// chunks. The file is then removed. Otherwise a disk on which every sync fails would collect a
/// thousand files. If two such files exist, the one with more chunks is kept.
void RecordingDisk::give_up_part() {
  if (!std::exchange(stands_, false)) return;
  // Size of all other files. If this file is already finished, bytes_before_ includes it.
  const std::uint64_t of_others = bytes_before_ - (open_ ? 0 : file_->size());
  // A failure does not matter, because the next file repeats what this file may lack.
  (void)finish_part();
  const auto chunks = static_cast<std::size_t>(
      std::count_if(kept_.begin(), kept_.end(), [](const Kept& kept) { return kept.end != 0; }));
  for (Kept& kept : kept_) kept.end = 0;
  if (synced_ != 0 || paths_.size() < 2) return;
  Repeated one{paths_.back(), chunks, bytes_before_ - of_others};
  bytes_before_ = of_others;
  paths_.pop_back();
  if (repeated_ && repeated_->chunks > chunks) std::swap(*repeated_, one);
  if (repeated_) files_->remove(repeated_->path.c_str());
  repeated_ = std::move(one);
}

/// Continues in a new file. If no file can be written, the failure is reported once without a file
/// name. When a file accepts data, the failure is reported again with that name.
Result<void> RecordingDisk::next_part(const Error& why) {
  const bool reported = std::exchange(given_up_, given_up_.value_or(why)).has_value();
  give_up_part();
  Result<void> result = put_kept();
  if (!result && !reported) failures_.push_back({why, ""});
  return result;
}

// A chunk that was written but never synced may be readable, so it does not count.
std::uint64_t RecordingDisk::unwritten() const {
  std::uint64_t messages = 0;
  for (const Kept& kept : kept_) {
    if (kept.written) continue;
    for (const auto& [channel, count] : kept.chunk.channel_messages) messages += count;
  }
  return messages;
}

std::optional<RecordingDisk::Sync> RecordingDisk::unsynced() const {
  if (!open_ || file_->size() == synced_) return std::nullopt;
  return Sync{file_, file_->size()};
}

Result<void> RecordingDisk::synced(const Sync& sync, const Result<void>& result) {
  if (!open_ || sync.file != file_) return {};  // the file was abandoned in the meantime
  if (!result) return next_part(result.error());
  forget_synced(sync.size);
  return {};
}

// Only chunks that a sync has confirmed are removed. The chunks are in the order of the file.
void RecordingDisk::forget_synced(std::uint64_t size) {
  synced_ = size;
  while (!kept_.empty() && kept_.front().end != 0 && kept_.front().end <= size) {
    kept_bytes_ -= kept_.front().chunk.bytes.size();
    kept_.pop_front();
  }
}

/// Finishes the file once. If that fails, the incomplete end is cut off. The file is then readable,
/// and `recover` can write its index.
Result<void> RecordingDisk::finish_part() {
  if (!std::exchange(open_, false)) return {};
  const std::uint64_t size = file_->size();
  Result<void> finished = writer_->finish();
  if (!finished) (void)file_->cut(size);
  bytes_before_ += file_->size();
  return finished;
}

// The order is: all chunks, the counts of the end, the index, and then one sync.
Result<void> RecordingDisk::finish_once(const McapMetadata& end) {
  KA_TRY(put_kept());
  KA_TRY(writer_->write(end));
  KA_TRY(finish_part());
  KA_TRY(file_->sync());
  forget_synced(file_->size());
  file_->close();
  return {};
}

/// Attempts to finish twice. If only the last sync failed, the file may still lack data, so a new
/// file is begun.
Result<void> RecordingDisk::finish(const McapMetadata& end) {
  Result<void> result = finish_once(end);
  if (result) return result;
  // The caller may call finish() every second. Only the first call reports the failure.
  const std::size_t reported = failures_.size();
  result = next_part(result.error());
  if (result) result = finish_once(end);
  if (!result) give_up_part();
  if (std::exchange(end_reported_, true)) failures_.resize(reported);
  return result;
}

std::uint64_t RecordingDisk::bytes() const {
  return bytes_before_ + (open_ ? file_->size() : 0) + (repeated_ ? repeated_->bytes : 0);
}

std::vector<std::string> RecordingDisk::paths() const {
  std::vector<std::string> all = paths_;
  if (repeated_) all.push_back(repeated_->path);
  return all;
}

}  // namespace kinalign
