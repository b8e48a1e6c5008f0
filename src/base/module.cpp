// SPDX-License-Identifier: Apache-2.0
#include "base/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <utility>

#include "base/error.h"

namespace orrery::base {
namespace {

std::filesystem::path& module_folder() {
  static std::filesystem::path folder;
  return folder;
}

}  // namespace

void set_module_folder(std::filesystem::path folder) { module_folder() = std::move(folder); }

const void* load_module(const std::string& room) {
  const std::filesystem::path folder =
      module_folder().empty() ? std::filesystem::read_symlink("/proc/self/exe").parent_path() : module_folder();
  const std::filesystem::path file = folder / ("orrery-" + room + ".so");
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const get = module != nullptr ? dlsym(module, ("orrery_" + room + "_functions").c_str()) : nullptr;
  if (get == nullptr) throw Error(ErrorKind::kInternal, std::string("cannot load ") + dlerror());
  return reinterpret_cast<const void* (*)()>(get)();
}

}  // namespace orrery::base
