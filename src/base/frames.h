// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace orrery::base {

/// Frames that a text like "1-10", "1-10:2", "1-10x2" or "1,3,7-9" names, each once, in the order of the text. A range
/// may go down; a step of 2 takes every other frame.
///
/// Errors     base::Error(kUsage) for what is no range, for numbers of more than seven digits and for more than
///            100,000 frames
std::vector<int> parse_frames(const std::string& text);

/// The shortest such text of frames: "1,3,7-9".
///
/// Domain     ascending
std::string frames_text(const std::vector<int>& frames);

/// True where a name has a place for the number of a frame: `##` and more, one digit each, or `%04d`. A single `#` is
/// a letter like any other.
bool has_frame_pattern(const std::string& name);

/// The name with all such places filled: "shot.####.exr" of frame 7 is "shot.0007.exr".
std::string with_frame(const std::string& name, int frame);

}  // namespace orrery::base
