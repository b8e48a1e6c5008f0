// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::image {

struct ExrOptions {
  bool as_float = false;             ///< half otherwise
  std::string compression = "zips";  ///< as check_compression takes it
  bool multipart = false;            ///< a part for each layer, instead of one with all channels
};

/// Whether a compression changes values.
///
/// Domain     a name that check_compression accepts
bool is_lossy(const std::string& compression);

/// Finds out whether a name is a compression of EXR, before there is anything to write.
///
/// Domain     none, rle, zip, zips, piz, dwaa or dwab, the last two with ":LEVEL" if wanted, as in dwaa:45
/// Errors     base::Error(kUsage) listing the known ones
void check_compression(const std::string& name);

/// Refuses to store mattes and other data by a compression that keeps only what eyes see. With a part for each layer
/// there is no need to: those of data are then compressed without loss.
///
/// Errors     base::Error(kUsage) with the remedy
void check_lossless(const std::vector<film::Plane>& planes, const ExrOptions& options);

}  // namespace orrery::image
