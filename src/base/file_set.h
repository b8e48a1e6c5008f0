// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace orrery::base {

/// The files that a run reads and writes. Every command adds all of its files here before it writes any, so that no
/// input is overwritten and no two outputs are the same file.
///
/// Files are compared by identity, not by path: by device and inode where they exist, and by their folder and name
/// where they do not. A symbolic link, a hard link and another spelling of a path are the same file.
class FileSet {
 public:
  /// Adds a file that is read. Reading a file twice is no conflict.
  ///
  /// `role`     for messages: "the scene", "points file"
  /// Result     false where it was an input already
  /// Errors     base::Error(kUsage) where it is also an output
  bool add_input(const std::filesystem::path& file, const std::string& role);

  /// Adds a file that is written.
  ///
  /// `role`     for messages: "-o", "--stats"
  /// Errors     base::Error(kUsage) where it is also an input or another output
  void add_output(const std::filesystem::path& file, const std::string& role);

 private:
  /// A file in the set.
  struct Entry {
    std::filesystem::path path;
    std::string role;
    bool is_output = false;
  };
  using Device = std::uint64_t;
  using Inode = std::uint64_t;
  struct Folder {
    Device device = 0;
    Inode inode = 0;
    bool exists = false;
  };
  /// Device and inode of a file with an empty name, or those of its folder with its name there.
  using Key = std::pair<std::pair<Device, Inode>, std::string>;

  const Folder& folder_of(const std::filesystem::path& file);
  std::vector<Key> keys_of(const std::filesystem::path& file);
  const Entry* find(const std::vector<Key>& keys) const;
  void insert(const std::vector<Key>& keys, const Entry& entry);

  std::vector<Entry> entries_;
  std::map<Key, std::size_t> index_;  ///< of an entry
  std::map<std::string, Folder> folders_;
};

}  // namespace orrery::base
