// SPDX-License-Identifier: Apache-2.0
#include "data/write_table.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "data/table_output.h"

namespace orrery::data {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

}  // namespace

TableOutput::TableOutput(const std::filesystem::path& path)
    : path_(path), file_(path), descriptor_(::open(file_.temporary().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)) {}

TableOutput::~TableOutput() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void TableOutput::flush() {
  if (buffer_.size() >= kBufferBytes) write();
}

void TableOutput::write() {
  std::string_view left = buffer_;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0)
      throw base::Error(base::ErrorKind::kIo, "writing " + path_.string() + " failed: " + std::strerror(errno));
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void TableOutput::finish() {
  write();
  const int status = ::close(descriptor_);
  descriptor_ = -1;
  if (status != 0)
    throw base::Error(base::ErrorKind::kIo, "writing " + path_.string() + " failed: " + std::strerror(errno));
  file_.commit();
}

void refuse_to_write(const std::filesystem::path& file, const std::string& text) {
  throw base::Error(base::ErrorKind::kUsage, "cannot write " + file.string() + ": " + text);
}

TableFormat table_format(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".ply") return TableFormat::kPly;
  if (extension == ".xyz") return TableFormat::kXyz;
  if (extension == ".npy") return TableFormat::kNpy;
  if (extension == ".csv") return TableFormat::kCsv;
  refuse_to_write(file, "unknown extension `" + extension + "`; use .ply, .xyz, .npy or .csv");
}

std::vector<std::string> write_table(const std::filesystem::path& file, const Table& table) {
  const TableFormat format = table_format(file);
  TableOutput out(file);
  std::vector<std::string> left_out;
  switch (format) {
    case TableFormat::kPly: left_out = write_ply_table(out, table); break;
    case TableFormat::kNpy: write_npy_table(out, table); break;
    case TableFormat::kCsv: write_csv_table(out, table); break;
    case TableFormat::kXyz: left_out = write_xyz_table(out, table); break;
  }
  out.finish();
  return left_out;
}

}  // namespace orrery::data
