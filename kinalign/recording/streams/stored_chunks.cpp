// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/stored_chunks.h"

#include "kinalign/core/file_version.h"
#include "kinalign/mcap/chunk.h"
#include "kinalign/mcap/reader.h"

#include <algorithm>

namespace kinalign {

namespace {

/// The error for a file whose bytes do not fit the index any more.
Error altered(const std::string& path) {
  return {path, 0, "a file that does not change while it is read", "a changed file"};
}

/// The unpacked records of a chunk, or the record of a message outside of chunks.
Result<std::string> records_of(const StoredChunk& chunk, const std::string& path,
                               const std::string& bytes) {
  if (bytes.size() < mcap_record_head) return Failure(altered(path));
  if (static_cast<McapOp>(bytes.front()) == McapOp::message) return bytes;
  const auto view = decode_mcap_chunk(std::string_view(bytes).substr(mcap_record_head));
  if (!view) return Failure(altered(path));
  // The end of a truncated chunk is missing, so as much as possible is unpacked.
  if (chunk.is_truncated) return unpack_truncated(*view, McapReader::most_record);
  return unpack(*view, McapReader::most_record).map_error([&](const Error&) {
    return altered(path);
  });
}

/// The messages in unpacked records, in the order of McapReader. Messages to skip are left out.
std::vector<ChunkMessage> messages_in(std::string_view records, const StoredChunk& chunk) {
  std::vector<ChunkMessage> messages;
  std::uint32_t place = 0;
  auto skipped = chunk.left_out.begin();
  while (const auto head = decode_mcap_head(records)) {
    // Messages after `end` are not needed. In a truncated chunk they may be damaged.
    if (place == chunk.end) break;
    if (head->op == McapOp{} || head->length > records.size() - mcap_record_head) break;
    const std::string_view content = records.substr(mcap_record_head, head->length);
    records.remove_prefix(mcap_record_head + head->length);
    if (head->op != McapOp::message) continue;
    const auto record = decode_mcap_record(head->op, content);
    if (!record) continue;
    // The index counts all messages of the chunk, including skipped ones.
    const std::uint32_t here = place++;
    if (skipped != chunk.left_out.end() && *skipped == here) {
      ++skipped;
      continue;
    }
    const auto& message = std::get<McapMessage>(*record);
    messages.push_back({message.channel, message.log_time, message.data});
  }
  return messages;
}

}  // namespace

StoredChunks::StoredChunks(FileSystem& files, std::vector<File> parts,
                           std::vector<StoredChunk> chunks)
    : files_(&files),
      parts_(std::move(parts)),
      chunks_(std::move(chunks)),
      open_files_(parts_.size()) {
  for (const StoredChunk& chunk : chunks_) bytes_ += chunk.size;
}

// Returns a chunk from the cache, or reads it. The oldest chunk leaves the cache first, because
// passes read forward and need it least.
Result<std::shared_ptr<const OpenedChunk>> StoredChunks::open(std::size_t k) const {
  // The lock is kept while reading, so that two passes never read the same chunk twice.
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(cache_.rbegin(), cache_.rend(),
                                  [k](const auto& cached) { return cached.first == k; });
  if (known != cache_.rend()) return known->second;
  auto opened = KA_TRY(read(chunks_[k]));
  cache_.emplace_back(k, opened);
  cached_bytes_ += opened->memory();
  // The newest chunk stays in the cache even if it alone exceeds the limit.
  for (; cached_bytes_ > most_cached && cache_.size() > 1; cache_.pop_front()) {
    cached_bytes_ -= cache_.front().second->memory();
  }
  return opened;
}

// Reads a chunk. The file's version is checked after reading, so that a change during reading is
// noticed.
Result<std::shared_ptr<const OpenedChunk>> StoredChunks::read(const StoredChunk& chunk) const {
  const File& part = parts_[chunk.part];
  auto& file = open_files_[chunk.part];
  // A file is opened when its first chunk is needed.
  if (!file) file.emplace(KA_TRY(InputFile::open(*files_, part.path)));
  std::string bytes(chunk.size, '\0');
  const std::size_t got = KA_TRY(file->read_at(chunk.at, bytes));
  KA_TRY(unchanged(part.path, part.version));
  if (got != bytes.size()) return Failure(altered(part.path));
  auto opened = std::make_shared<OpenedChunk>();
  opened->bytes = KA_TRY(records_of(chunk, part.path, bytes));
  opened->messages = messages_in(opened->bytes, chunk);
  return std::shared_ptr<const OpenedChunk>(std::move(opened));
}

MessagePass::MessagePass(std::shared_ptr<const StoredChunks> chunks,
                         std::vector<std::uint16_t> channels)
    : chunks_(std::move(chunks)), channels_(std::move(channels)) {
  // The list is sorted, because the channels of each chunk are searched in it.
  std::sort(channels_.begin(), channels_.end());
}

// Goes on to the next chunk that contains one of the pass's channels. Other chunks are not read.
Result<bool> MessagePass::next_chunk(const Take& take) {
  const auto is_mine = [this](std::uint16_t channel) {
    return std::binary_search(channels_.begin(), channels_.end(), channel);
  };
  while (next_ < chunks_->size()) {
    const std::size_t k = next_++;
    done_ += (*chunks_)[k].size;
    const auto& there = (*chunks_)[k].channels;
    if (std::none_of(there.begin(), there.end(), is_mine)) continue;
    // This pointer keeps the chunk in memory while its messages are used, even if the cache drops
    // it.
    const auto chunk = KA_TRY(chunks_->open(k));
    for (const ChunkMessage& message : chunk->messages) {
      if (is_mine(message.channel)) KA_TRY(take(message));
    }
    return true;
  }
  return false;
}

}  // namespace kinalign
