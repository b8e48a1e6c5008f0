// SPDX-License-Identifier: Apache-2.0
#include "base/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"

namespace orrery::base {
namespace {

constexpr int kFlags = RTLD_NOW | RTLD_LOCAL;

std::filesystem::path& module_folder() {
  static std::filesystem::path folder;
  return folder;
}

/// Opens a module of the program. If `stubs` contains stub libraries, those are loaded first: glibc then takes them for
/// the libraries of their names, which the module needs. A module that cannot be loaded with them gets the libraries.
void* open_with_stubs(const std::filesystem::path& file, const std::filesystem::path& stubs) {
  std::vector<void*> opened;
  std::error_code ignored;  // most modules have none
  for (const auto& stub : std::filesystem::directory_iterator(stubs, ignored))
    if (void* const library = dlopen(stub.path().c_str(), kFlags)) opened.push_back(library);
  if (void* const module = dlopen(file.c_str(), kFlags)) return module;
  for (void* const library : opened) dlclose(library);
  return dlopen(file.c_str(), kFlags);
}

}  // namespace

void set_module_folder(std::filesystem::path folder) { module_folder() = std::move(folder); }

const void* load_module(const std::string& room) {
  const std::string name = "orrery-" + room;
  void* module = nullptr;
  if (module_folder().empty()) {
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    module = open_with_stubs(folder / (name + ".so"), folder / (name + "-stubs"));
  } else {
    // Another program's process, for example Python's, whose other modules may need the libraries.
    module = dlopen((module_folder() / (name + ".so")).c_str(), kFlags);
  }
  void* const get = module != nullptr ? dlsym(module, ("orrery_" + room + "_functions").c_str()) : nullptr;
  if (get == nullptr) throw Error(ErrorKind::kInternal, std::string("cannot load ") + dlerror());
  return reinterpret_cast<const void* (*)()>(get)();
}

}  // namespace orrery::base
