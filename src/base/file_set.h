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
/// input is overwritten, no two outputs are the same file, and each output can be created.
///
/// Files are compared by identity, not by path: by device and inode if they exist, else by folder and name. Symbolic
/// links, hard links and different spellings of a path count as the same file.
class FileSet {
 public:
  /// Adds an input file. Reading a file twice is not a conflict.
  ///
  /// `role`     for messages: "the scene", "points file"
  /// Result     false if it was already an input
  /// Errors     base::Error(kUsage) if it is also an output
  bool add_input(const std::filesystem::path& file, const std::string& role);

  /// Adds an output file of a later step, which checks whether it can be created.
  ///
  /// `role`     for messages: "-o", "--stats"
  /// Errors     base::Error(kUsage) if it is also an input or another output
  void reserve(const std::filesystem::path& file, const std::string& role);

  /// Adds an output file.
  ///
  /// Errors     those of reserve() and check_creatable()
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
  /// Device and inode of the file and an empty name, or device and inode of its folder and its name.
  using Key = std::pair<std::pair<Device, Inode>, std::string>;

  const Folder& folder_of(const std::filesystem::path& file);
  std::vector<Key> keys_of(const std::filesystem::path& file);
  /// Inserts a file, unless it is known; then returns its entry.
  const Entry* insert(const Entry& entry);

  std::vector<Entry> entries_;
  std::map<Key, std::size_t> index_;  ///< into entries_
  std::map<std::string, Folder> folders_;
};

}  // namespace orrery::base
