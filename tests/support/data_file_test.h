// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "data/data_file.h"
#include "support/temp_dir.h"

namespace orrery::support {

/// Tests of a reader: each opens a data file with a given content.
class DataFileTest : public testing::Test {
 protected:
  /// `name`   of the file, with the format's extension
  explicit DataFileTest(std::string name) : name_(std::move(name)) {}

  std::filesystem::path write(const std::string& content) {
    write_bytes(folder_ / name_, content);
    return folder_ / name_;
  }
  std::unique_ptr<data::DataFile> open(const std::string& content) { return data::open(write(content)); }

  /// The first diagnostic of opening the file and reading x; empty if there is none.
  base::Diagnostic error_of(const std::string& content) {
    try {
      open(content)->read(0, {"x"});
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      return error.diagnostics().at(0);
    }
    return {};
  }

  TempDir folder_;

 private:
  std::string name_;
};

}  // namespace orrery::support
