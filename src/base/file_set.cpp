// SPDX-License-Identifier: Apache-2.0
#include "base/file_set.h"

#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/error.h"

namespace orrery::base {
namespace {

namespace fs = std::filesystem;

std::string described(const fs::path& file, const std::string& role) { return file.string() + " (" + role + ")"; }

}  // namespace

const FileSet::Folder& FileSet::folder_of(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const auto [at, is_new] = folders_.try_emplace(folder.string());
  struct stat status {};
  if (is_new && ::stat(folder.c_str(), &status) == 0) at->second = {status.st_dev, status.st_ino, true};
  return at->second;
}

std::vector<FileSet::Key> FileSet::keys_of(const fs::path& file) {
  std::vector<Key> keys;
  fs::path entry = file;
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) {
    keys.push_back({{status.st_dev, status.st_ino}, ""});
    std::error_code ignored;
    if (fs::is_symlink(file, ignored)) entry = fs::canonical(file, ignored);
  } else {
    entry = link_target(file);
  }
  // Existing files are also registered by name: a file may be replaced, and get another inode, before the next lookup.
  const Folder& folder = folder_of(entry);
  std::error_code ignored;
  const std::string name =
      folder.exists ? entry.filename().string() : fs::absolute(entry, ignored).lexically_normal().string();
  keys.push_back({{folder.device, folder.inode}, name});
  return keys;
}

const FileSet::Entry* FileSet::find(const std::vector<Key>& keys) const {
  for (const Key& key : keys)
    if (const auto found = index_.find(key); found != index_.end()) return &entries_[found->second];
  return nullptr;
}

void FileSet::insert(const std::vector<Key>& keys, const Entry& entry) {
  for (const Key& key : keys) index_.emplace(key, entries_.size());
  entries_.push_back(entry);
}

bool FileSet::add_input(const fs::path& file, const std::string& role) {
  const std::vector<Key> keys = keys_of(file);
  const Entry* const known = find(keys);
  if (known != nullptr && known->is_output)
    throw Error(ErrorKind::kUsage, described(known->path, known->role) + " would overwrite " + described(file, role) +
                                       "; choose another name");
  if (known != nullptr) return false;
  insert(keys, {file, role, false});
  return true;
}

void FileSet::add_output(const fs::path& file, const std::string& role) {
  const std::vector<Key> keys = keys_of(file);
  const Entry* const known = find(keys);
  if (known != nullptr && known->is_output)
    throw Error(ErrorKind::kUsage, described(file, role) + " and " + described(known->path, known->role) +
                                       " are the same file; choose another name");
  if (known != nullptr)
    throw Error(ErrorKind::kUsage, described(file, role) + " would overwrite " + described(known->path, known->role) +
                                       "; choose another name");
  insert(keys, {file, role, true});
}

}  // namespace orrery::base
