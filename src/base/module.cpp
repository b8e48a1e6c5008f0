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

/// The folder that set_module_folder() has set, or none.
std::filesystem::path& chosen_folder() {
  static std::filesystem::path folder;
  return folder;
}

std::filesystem::path module_folder() {
  if (!chosen_folder().empty()) return chosen_folder();
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
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

void set_module_folder(std::filesystem::path folder) { chosen_folder() = std::move(folder); }

std::filesystem::path shared_folder() { return module_folder() / "../../share/orrery"; }

const void* load_module(const std::string& room) {
  const std::string name = "orrery-" + room;
  const std::filesystem::path file = module_folder() / (name + ".so");
  // In another program's process, for example Python's, other modules may need the libraries.
  void* const module = chosen_folder().empty() ? open_with_stubs(file, module_folder() / (name + "-stubs"))
                                               : dlopen(file.c_str(), kFlags);
  void* const get = module != nullptr ? dlsym(module, ("orrery_" + room + "_functions").c_str()) : nullptr;
  if (get == nullptr) throw Error(ErrorKind::kInternal, std::string("cannot load ") + dlerror());
  return reinterpret_cast<const void* (*)()>(get)();
}

}  // namespace orrery::base
