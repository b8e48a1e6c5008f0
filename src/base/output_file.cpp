// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <string_view>

#include "base/file_error.h"

namespace orrery::base {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), file_(path), descriptor_(::open(file_.temporary().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)) {}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::flush() {
  if (buffer_.size() >= kBufferBytes) write();
}

void OutputFile::write() {
  std::string_view left = buffer_;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path_, errno);
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void OutputFile::finish(bool synced) {
  write();
  const int status = ::close(descriptor_);
  descriptor_ = -1;
  if (status != 0) fail_to_write(path_, errno);
  synced ? file_.commit() : file_.commit_unsynced();
}

void write_text_file(const std::filesystem::path& path, std::string_view text, bool synced) {
  OutputFile file(path);
  file.buffer() = text;
  file.finish(synced);
}

}  // namespace orrery::base
