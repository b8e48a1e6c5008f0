// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "load/read_scene.h"
#include "scene/validate.h"
#include "support/temp_dir.h"

namespace orrery::support {

/// Reads and checks a scene file, without the files that it names.
inline load::ReadResult read_scene(const std::filesystem::path& file, const load::Overrides& overrides = {}) {
  const load::SceneSource source{.file = file, .overrides = overrides};
  load::SceneReader reader(source);
  const std::optional<scene::Scene>& closing = reader.closing();
  reader.add(scene::validate(reader.scene()));
  reader.add(scene::warn_of_coincident(reader.scene(), closing ? &*closing : nullptr));
  return reader.finish();
}

/// Temporary scene files of one test, and the reader's diagnostics.
class SceneFiles {
 public:
  using Reader = std::function<load::ReadResult(const std::filesystem::path&, const load::Overrides&)>;

  /// `read`     read_scene() reads no data files; see support/read_scene_file.h
  explicit SceneFiles(Reader read = read_scene) : read_(std::move(read)) {}

  /// Writes a file next to scene.toml.
  void add(const std::string& name, const std::string& bytes) { write_bytes(folder_ / name, bytes); }

  /// Reads `text` as scene.toml; fails the test if the reader rejects it.
  load::ReadResult read(const std::string& text, const load::Overrides& overrides = {}) {
    add("scene.toml", text);
    try {
      return read_(folder_ / "scene.toml", overrides);
    } catch (const base::Error& error) {
      ADD_FAILURE() << told(error);
      return {};
    }
  }

  /// Returns the errors as the user sees them, without the folder; without errors, the warnings.
  std::string diagnostics(const std::string& text, const load::Overrides& overrides = {}) {
    add("scene.toml", text);
    try {
      std::string out;
      for (const base::Diagnostic& f : read_(folder_ / "scene.toml", overrides).warnings) out += base::formatted(f);
      return without_folder(out);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      return told(error);
    }
  }

  const TempDir& folder() const { return folder_; }

  std::string told(const base::Error& error) const {
    std::string out;
    for (const base::Diagnostic& f : error.diagnostics()) out += base::formatted(f);
    return without_folder(out.empty() ? error.what() : out);
  }

 private:
  std::string without_folder(std::string text) const {
    const std::string prefix = folder_.path().string() + "/";
    for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
    return text;
  }

  Reader read_;
  TempDir folder_;
};

}  // namespace orrery::support
