// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/file_set.h"
#include "load/overrides.h"
#include "points/load_points.h"
#include "scene/diagnostic.h"
#include "scene/scene.h"

namespace orrery::load {

/// The value of a key, and its origin.
struct Setting {
  std::string key;     ///< "camera.vfov"
  std::string value;   ///< as written in a scene file
  std::string origin;  ///< "default", "scene.toml:12", "--set", "--samples"
};

/// Result of reading a scene.
struct ReadResult {
  scene::Scene scene;
  std::vector<base::Diagnostic> warnings;
  std::vector<Setting> settings;  ///< all keys that a scene has at most once, in documentation order
  /// The scene at shutter close, without data; `scene` is then the scene at shutter open. Empty without motion blur.
  std::optional<scene::Scene> closing = {};
  /// The scenes a frame before and after, like `closing`; empty without motion vectors.
  std::array<std::optional<scene::Scene>, 2> neighbors = {};
};

/// The frame that is read by default.
inline constexpr int kFirstFrame = 1;

/// A scene as specified on the command line: file, overrides, and a frame of its animation.
struct SceneSource {
  std::filesystem::path file;
  Overrides overrides = {};
  int frame = kFirstFrame;  ///< selects the values of animated keys, and the files and frames of data
  std::shared_ptr<const std::string> text = {};       ///< text of the scene; null: read the file
  bool has_file = true;                               ///< false: `file` is only a name
  points::OpenData open_data = {};                    ///< see points::LoadRequest
  std::shared_ptr<points::LoadedPoints> loaded = {};  ///< see points::LoadRequest
  /// Identifies the contents of a data file; empty: base::file_version.
  std::function<std::string(const std::filesystem::path&)> data_version = {};
  std::optional<int> typed_lines = {};  ///< see SourceText::set_typed_lines()
};

/// Whether a scene is posed at the frame of its source, or left as authored: animated keys then have their own values,
/// and names of files their frame patterns.
enum class Pose { kAtFrame, kAuthored };

/// A scene file that is being read: the scene that it describes, and the places of its keys for diagnostics, which are
/// collected until finish(). Reads no other file: the points tables have no spheres.
///
/// Reference  docs/scene-format.md
class SceneReader {
 public:
  /// Reads the text, and poses the scene.
  ///
  /// Domain     `source` outlives this
  /// Errors     base::Error: kMissingInput if the file cannot be opened; kIo; kBadData if it is not TOML
  explicit SceneReader(const SceneSource& source, Pose pose = Pose::kAtFrame);
  ~SceneReader();

  /// Keys that cannot be read have their defaults.
  scene::Scene& scene();
  /// See ReadResult::closing.
  std::optional<scene::Scene>& closing();

  bool has_errors() const;
  /// False if an error is known about a key whose full name begins with `name`: "points[0].file", "color.".
  bool is_read(const std::string& name) const;

  /// Adds diagnostics at the locations of their keys. Those that may follow from the default of a key that could not be
  /// read are dropped, and so are warnings if the scene has errors.
  void add(const std::vector<scene::SceneDiagnostic>& diagnostics);

  /// Adds the error of a file at the location of the key that names it, and the diagnostics in the file.
  void add_file_error(const std::string& key, const base::Error& error);

  /// Ends reading.
  ///
  /// Errors     base::Error with the diagnostics, the first kMaxErrors of them: kMissingInput if all are files that
  ///            cannot be opened, else kBadData
  ReadResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the scene as authored, without checks: keys that cannot be read have their defaults. For the files that it
/// names, and for writing it again.
///
/// Errors     base::Error(kBadData) for invalid TOML; kMissingInput, kIo
scene::Scene authored_scene(const SceneSource& source);

/// Adds the files that a scene references at these frames. Reads the scene file, but no other file.
///
/// Errors     those of add_scene_files and authored_scene
void add_named_files(const SceneSource& scene, const std::vector<int>& frames, base::FileSet& files);

/// Adds the files that a scene references.
///
/// `frames`   of sequences of files; a scene that was read at a frame has none
/// Errors     base::Error(kUsage) if one is an output
void add_scene_files(const std::filesystem::path& scene_file, const scene::Scene& scene, base::FileSet& files,
                     const std::vector<int>& frames = {});

/// Adds an OCIO config, from --ocio or a scene, and the config in $OCIO, if they are files.
///
/// Errors     those of add_scene_files
void add_ocio_configs(const std::string& config, base::FileSet& files);

/// Maximum size of a scene file, bytes: a million [[sphere]] tables. Larger scenes use points files.
inline constexpr std::uint64_t kLargestSceneFile = 256u << 20;

/// True for the name of a scene file; other files are data.
bool is_scene_file(const std::filesystem::path& file);

/// Throws base::Error(kUsage), which names the right command, if a text that is not a scene is a data file.
void refuse_data_file(const std::filesystem::path& file, std::string_view text);

/// Reads the text of a scene.
///
/// Errors     base::Error(kMissingInput) if it cannot be opened or is not a regular file, kBadData if it is larger than
///            `largest_bytes`, kIo if reading fails; those of refuse_data_file()
std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes);

/// Returns the version of toml++.
std::string toml_version();

}  // namespace orrery::load
