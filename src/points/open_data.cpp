// SPDX-License-Identifier: Apache-2.0
#include "points/open_data.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "data/data_file.h"
#include "particles/open.h"

namespace orrery::points {
namespace {

/// A scene rarely has more data files with several frames.
constexpr std::size_t kMaxOpen = 4;

struct OpenFile {
  std::filesystem::path path;
  std::optional<int> component;
  std::uintmax_t size = 0;
  std::filesystem::file_time_type time;
  std::shared_ptr<data::DataFile> file;

  bool is_same(const OpenFile& other) const {
    return path == other.path && component == other.component && size == other.size && time == other.time;
  }
};

/// A file that stays open when this is destroyed.
class SharedFile final : public data::DataFile {
 public:
  explicit SharedFile(std::shared_ptr<data::DataFile> file) : file_(std::move(file)) { format = file_->format; }

  int frame_count() override { return file_->frame_count(); }
  data::FrameInfo describe(int frame) override { return file_->describe(frame); }
  data::Table read(int frame, const std::vector<std::string>& columns) override { return file_->read(frame, columns); }
  std::uint64_t memory() const override { return file_->memory(); }

 private:
  std::shared_ptr<data::DataFile> file_;
};

}  // namespace

OpenData open_once() {
  return [open = std::make_shared<std::vector<OpenFile>>()](const std::filesystem::path& path,
                                                            const data::OpenOptions& options) {
    std::error_code ignored;
    OpenFile wanted{path, options.component, std::filesystem::file_size(path, ignored),
                    std::filesystem::last_write_time(path, ignored), nullptr};
    const auto found = std::find_if(open->begin(), open->end(), [&](const OpenFile& o) { return o.is_same(wanted); });
    if (found != open->end()) {
      wanted = std::move(*found);
      open->erase(found);
    } else {
      // Closed first: decompressed data take memory.
      std::erase_if(*open, [&](const OpenFile& o) { return o.path == path; });
      if (open->size() == kMaxOpen) open->erase(open->begin());
      wanted.file = particles::open(path, options);
    }
    open->push_back(std::move(wanted));
    return std::make_unique<SharedFile>(open->back().file);
  };
}

}  // namespace orrery::points
