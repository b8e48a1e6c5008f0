// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "film/forward.h"

namespace orrery::image {

struct ExrOptions {
  bool as_float = false;             ///< store colours and vectors as float instead of half
  std::string compression = "zips";  ///< a name that check_compression() accepts
  bool multipart = false;            ///< write one part per layer instead of a single part
};

/// Whether a compression is lossy.
///
/// Domain     a name that check_compression accepts
bool is_lossy(const std::string& compression);

/// Checks the name of an EXR compression before rendering: none, rle, zip, zips, piz, dwaa or dwab. The last two accept
/// a level, e.g. dwaa:45.
///
/// Errors     base::Error(kUsage) with the known names
void check_compression(const std::string& name);

/// Refuses a lossy compression of mattes and other data layers. Multi-part files are accepted, since their data parts
/// are compressed without loss.
///
/// Errors     base::Error(kUsage) with the remedy
void check_lossless(const std::vector<film::Plane>& planes, const ExrOptions& options);

}  // namespace orrery::image
