// SPDX-License-Identifier: Apache-2.0
#include "format/written_text.h"

#include <fstream>
#include <iterator>

#include <fmt/core.h>

#include "base/error.h"
#include "base/hash.h"

namespace orrery::format {
namespace {

constexpr const char* kMark = "# Written by orrery, which replaces it only if unchanged: checksum ";

}  // namespace

std::string marked_text(const std::string& text) { return fmt::format("{}{}\n{}", kMark, base::text_hash(text), text); }

void check_unedited(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return;
  std::ifstream in(file, std::ios::binary);
  std::string mark;
  std::getline(in, mark);
  const bool is_ours = mark.starts_with(kMark);
  const std::string text = is_ours ? std::string(std::istreambuf_iterator<char>(in), {}) : "";
  if (is_ours && fmt::format("{}\n{}", mark, text) == marked_text(text)) return;
  throw base::Error(base::ErrorKind::kCannotCreate,
                    fmt::format("cannot create {}: the existing file was {}; choose another name, or replace it with "
                                "--force",
                                file.string(), is_ours ? "edited since orrery wrote it" : "not written by orrery"));
}

}  // namespace orrery::format
