// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace orrery::base {

/// Parses a frame range such as "1-10", "1-10:2", "1-10x2" or "1,3,7-9". Each frame is returned once, in the order of
/// the text. A range may descend; a step of 2 selects every other frame.
///
/// Errors     base::Error(kUsage) for invalid ranges, numbers of more than seven digits and more than 100,000 frames
std::vector<int> parse_frames(const std::string& text);

/// Formats frames as the shortest range that parse_frames() accepts: "1,3,7-9".
///
/// Domain     ascending frames
std::string frames_text(const std::vector<int>& frames);

/// True if a file name has a pattern for the frame number: `##` or more, one digit each, or `%04d`. A single `#` is an
/// ordinary character, and so are all characters of folders.
bool has_frame_pattern(const std::string& name);

/// Throws an error for a name without frame pattern that several frames would share.
///
/// `example`  names with a pattern
[[noreturn]] void refuse_one_name(const std::string& name, std::size_t frames, const std::string& example);

/// Replaces all such patterns by the frame number: "shot.####.exr" becomes "shot.0007.exr" for frame 7.
std::string with_frame(const std::string& name, int frame);

/// True if the name of an input is a pattern for a sequence of files. It is not if a file has this very name, such as
/// "20%density.ply".
bool is_sequence(const std::filesystem::path& input);

/// Returns the name of an input at a frame: of a sequence, that of the frame's file.
///
/// `folder`   folder to which the name is relative
std::string input_at_frame(const std::filesystem::path& folder, const std::string& name, int frame);

}  // namespace orrery::base
