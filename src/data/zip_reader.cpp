// SPDX-License-Identifier: Apache-2.0
#include "data/zip_reader.h"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "base/stop_point.h"
#include "data/byte_source.h"
#include "data/faults.h"

namespace orrery::data {

/// Connects libarchive to a byte source.
struct ZipReader::State {
  explicit State(const ByteSource& source) : bytes(source), in(archive_read_new(), &archive_read_free) {
    if (!in) throw std::bad_alloc();
  }

  /// Raises libarchive's error, or the exception that stopped a callback.
  la_ssize_t check(la_ssize_t status) {
    if (failure) std::rethrow_exception(failure);
    if (status >= ARCHIVE_OK) return status;
    const char* const why = archive_error_string(in.get());
    Faults(bytes.file()).fail(0, std::string("damaged ZIP archive: ") + (why != nullptr ? why : "unknown error"));
  }

  static la_ssize_t read(archive*, void* data, const void** out) {
    State& state = *static_cast<State*>(data);
    try {
      state.block = state.bytes.text(state.at, kBlockBytes);
    } catch (...) {
      state.failure = std::current_exception();
      return ARCHIVE_FATAL;
    }
    state.at += state.block.size();
    *out = state.block.data();
    return static_cast<la_ssize_t>(state.block.size());
  }
  static la_int64_t skip(archive*, void* data, la_int64_t count) {
    State& state = *static_cast<State*>(data);
    const std::uint64_t skipped =
        std::min(static_cast<std::uint64_t>(std::max<la_int64_t>(count, 0)), state.bytes.size() - state.at);
    state.at += skipped;
    return static_cast<la_int64_t>(skipped);
  }
  static la_int64_t seek(archive*, void* data, la_int64_t offset, int whence) {
    State& state = *static_cast<State*>(data);
    const auto size = static_cast<la_int64_t>(state.bytes.size());
    const la_int64_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? static_cast<la_int64_t>(state.at) : size;
    if (offset < -base) return ARCHIVE_FATAL;
    state.at = static_cast<std::uint64_t>(std::min(base + std::min(offset, size), size));
    return static_cast<la_int64_t>(state.at);
  }

  static constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

  const ByteSource& bytes;
  std::unique_ptr<archive, decltype(&archive_read_free)> in;
  std::uint64_t at = 0;
  std::string block;
  std::exception_ptr failure;
};

ZipReader::ZipReader(const ByteSource& bytes) : state_(std::make_unique<State>(bytes)) {
  archive* const in = state_->in.get();
  archive_read_support_format_zip(in);
  archive_read_set_read_callback(in, &State::read);
  archive_read_set_skip_callback(in, &State::skip);
  archive_read_set_seek_callback(in, &State::seek);
  archive_read_set_callback_data(in, state_.get());
  state_->check(archive_read_open1(in));
}

ZipReader::~ZipReader() = default;

bool ZipReader::next() {
  archive_entry* entry = nullptr;
  const int status = archive_read_next_header(state_->in.get(), &entry);
  // A warning is about the name, e.g. its encoding.
  if (status != ARCHIVE_WARN && state_->check(status) == ARCHIVE_EOF) return false;
  const char* const name = archive_entry_pathname(entry);
  name_ = name != nullptr ? name : "";
  return true;
}

ByteBlocks ZipReader::read(std::uint64_t count) {
  const base::StopPoint stop;
  ByteBlocks out;
  while (out.size() < count) {
    stop.check();
    // Grows only by what was decompressed: the headers may declare any size.
    const std::span<char> room = out.room(count - out.size());
    const la_ssize_t got = state_->check(archive_read_data(state_->in.get(), room.data(), room.size()));
    if (got == 0) break;
    out.append(static_cast<std::size_t>(got));
  }
  return out;
}

std::string ZipReader::read_text(std::size_t count) {
  const ByteBlocks bytes = read(count);
  std::string out(static_cast<std::size_t>(bytes.size()), '\0');
  bytes.read(0, out.size(), out.data());
  return out;
}

}  // namespace orrery::data
