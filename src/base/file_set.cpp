// SPDX-License-Identifier: Apache-2.0
#include "base/file_set.h"

#include <sys/stat.h>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"

namespace orrery::base {
namespace {

namespace fs = std::filesystem;

std::string described(const fs::path& file, const std::string& role) {
  return fmt::format("{} ({})", file.string(), role);
}

}  // namespace

const FileSet::Folder& FileSet::folder_of(const fs::path& file) {
  const fs::path folder = base::folder_of(file);
  const auto [at, is_new] = folders_.try_emplace(folder.string());
  struct stat status {};
  if (is_new && ::stat(folder.c_str(), &status) == 0) at->second = {status.st_dev, status.st_ino, true};
  return at->second;
}

std::vector<FileSet::Key> FileSet::keys_of(const fs::path& file) {
  std::vector<Key> keys;
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) keys.push_back({{status.st_dev, status.st_ino}, ""});
  const fs::path entry = link_target(file);
  // Existing files are also registered by name: a file may be replaced, and get another inode, before the next lookup.
  const Folder& folder = folder_of(entry);
  std::error_code ignored;
  const std::string name =
      folder.exists ? entry.filename().string() : fs::absolute(entry, ignored).lexically_normal().string();
  keys.push_back({{folder.device, folder.inode}, name});
  return keys;
}

const FileSet::Entry* FileSet::insert(const Entry& entry) {
  const std::vector<Key> keys = keys_of(entry.path);
  for (const Key& key : keys)
    if (const auto known = index_.find(key); known != index_.end()) return &entries_[known->second];
  for (const Key& key : keys) index_.emplace(key, entries_.size());
  entries_.push_back(entry);
  return nullptr;
}

bool FileSet::add_input(const fs::path& file, const std::string& role) {
  const Entry* const known = insert({file, role, false});
  if (known != nullptr && known->is_output)
    refuse(fmt::format("{} would overwrite {}; choose another name", described(known->path, known->role),
                       described(file, role)));
  return known == nullptr;
}

void FileSet::reserve(const fs::path& file, const std::string& role) {
  const Entry* const known = insert({file, role, true});
  if (known == nullptr) return;
  const std::string own = described(file, role), other = described(known->path, known->role);
  refuse(known->is_output ? fmt::format("{} and {} are the same file; choose another name", own, other)
                          : fmt::format("{} would overwrite {}; choose another name", own, other));
}

void FileSet::add_output(const fs::path& file, const std::string& role) {
  reserve(file, role);
  check_creatable(file);
}

}  // namespace orrery::base
