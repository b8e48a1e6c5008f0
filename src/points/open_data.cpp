// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/input_file.h"
#include "data/data_file.h"
#include "points/load_points.h"

namespace orrery::points {
namespace {

/// A scene rarely has more data files with several frames.
constexpr std::size_t kMaxOpen = 4;

struct OpenFile {
  std::string name;     ///< absolute path
  std::string version;  ///< see base::file_version
  std::optional<int> component;
  std::string topology;  ///< its version; empty: none
  std::shared_ptr<data::DataFile> file;
};

}  // namespace

OpenData open_once() {
  return [open = std::make_shared<std::vector<OpenFile>>()](
             const std::filesystem::path& path, const data::OpenOptions& options) -> std::shared_ptr<data::DataFile> {
    const std::string name = std::filesystem::absolute(path).lexically_normal().string();
    const std::string topology = options.topology.empty() ? "" : base::file_version(options.topology.string());
    OpenFile wanted{name, base::file_version(name), options.component, topology, nullptr};
    const auto found = std::find_if(open->begin(), open->end(), [&](const OpenFile& o) {
      return o.version == wanted.version && o.component == wanted.component && o.topology == wanted.topology;
    });
    if (found != open->end()) {
      wanted = std::move(*found);
      open->erase(found);
    } else {
      // Closed first: decompressed data take memory.
      std::erase_if(*open, [&](const OpenFile& o) { return o.name == name; });
      if (open->size() == kMaxOpen) open->erase(open->begin());
      wanted.file = data::open(path, options);
    }
    open->push_back(std::move(wanted));
    return open->back().file;
  };
}

OpenData handed_over(OpenData open) {
  return [open = std::make_shared<OpenData>(std::move(open))](const std::filesystem::path& path,
                                                              const data::OpenOptions& options) {
    std::shared_ptr<data::DataFile> file = (*open)(path, options);
    *open = open_once();
    return file;
  };
}

}  // namespace orrery::points
