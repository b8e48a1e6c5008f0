// SPDX-License-Identifier: Apache-2.0
#include "display/config.h"

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <sstream>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "display/settings.h"

namespace orrery::display {

extern const char* const kBuiltinConfig;  // builtin_config.cpp.in

namespace {

namespace ocio = OCIO_NAMESPACE;

/// Collects OCIO's log messages during its lifetime.
class LogCapture {
 public:
  explicit LogCapture(std::vector<std::string>& lines) : lock_(mutex()) {
    ocio::SetLoggingFunction([&lines](const char* text) {
      std::string line(text);
      while (!line.empty() && line.back() == '\n') line.pop_back();
      if (!line.empty()) lines.push_back(line);
    });
  }
  ~LogCapture() { ocio::ResetToDefaultLoggingFunction(); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;  // OCIO has one logging function per process
    return one;
  }
  std::lock_guard<std::mutex> lock_;
};

/// Returns whether a name denotes a config built into newer versions of OCIO, which is not a file.
bool is_library_config(const std::string& name) { return name.starts_with("ocio://"); }

/// OCIO reads this variable when it creates a processor, and throws an exception that does not name it.
void check_optimization_flags() {
  const char* const text = std::getenv(ocio::OCIO_OPTIMIZATION_FLAGS_ENVVAR);
  if (text == nullptr || *text == '\0') return;
  char* end = nullptr;
  errno = 0;
  static_cast<void>(std::strtoul(text, &end, 0));
  if (std::isdigit(static_cast<unsigned char>(*text)) == 0 || *end != '\0' || errno != 0)
    base::refuse(fmt::format("${} is `{}`; must be a number such as 0x1FF, or unset",
                             ocio::OCIO_OPTIMIZATION_FLAGS_ENVVAR, base::printable(text)));
}

/// The version of the library, for errors that a newer one would not have. Some of its messages say it themselves.
std::string version_note(const std::string& file, const std::string& message) {
  const std::string version = ocio::GetVersion();
  if (message.find(version) != std::string::npos) return {};
  const bool is_new_kind = is_library_config(file) || std::filesystem::path(file).extension() == ".ocioz";
  return fmt::format("; this is OpenColorIO {}{}", version,
                     is_new_kind ? ", and ocio:// configs and .ocioz archives need 2.2 or later"
                                 : ", and configs for later versions may not load");
}

/// Parsed once: that takes several milliseconds, of the 45 that an image has while the camera moves.
ocio::ConstConfigRcPtr builtin_config() {
  std::istringstream text(kBuiltinConfig);
  static const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromStream(text);
  return config;
}

ocio::ConstConfigRcPtr load(const std::string& file) {
  if (file.empty()) return builtin_config();
  if (!is_library_config(file)) base::require_readable(file);
  try {
    ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file.c_str());
    config->validate();
    return config;
  } catch (const std::exception& error) {
    throw base::Error(base::ErrorKind::kBadData, fmt::format("the OCIO config {} cannot be used: {}{}", file,
                                                             error.what(), version_note(file, error.what())));
  }
}

/// The value of $OCIO; empty if unset.
std::string config_of_environment() {
  const char* const name = std::getenv("OCIO");
  return name != nullptr ? name : "";
}

}  // namespace

std::vector<std::filesystem::path> config_files(const std::string& config) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : {config, config_of_environment()})
    if (!name.empty() && !is_library_config(name)) files.emplace_back(name);
  return files;
}

Config load_config(const std::string& file) {
  check_optimization_flags();
  Config out;
  const std::string environment = config_of_environment();
  const bool is_of_environment = file.empty() && !environment.empty();
  const std::string name = is_of_environment ? environment : file;
  const LogCapture capture(out.warnings);
  try {
    out.config = load(name);
  } catch (const base::Error& error) {
    if (!is_of_environment) throw;
    throw base::Error(error.kind(), std::string("$OCIO: ") + error.what());
  }
  out.name = name.empty() ? "built-in" : name;
  return out;
}

}  // namespace orrery::display
