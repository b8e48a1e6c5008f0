// SPDX-License-Identifier: Apache-2.0
#include "base/frames.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <set>
#include <string_view>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::base {
namespace {

constexpr int kLargestFrame = 9'999'999;
/// Maximum number of frames, more than an hour of animation: all jobs are listed before the first one starts.
constexpr std::size_t kMaxFrames = 100'000;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  base::refuse(fmt::format("`{}` is not a frame range: {}; write 1-10, 1-10x2 or 1,3,7-9", text, why));
}

/// Parses a number at the front of `rest`, the unread end of `text`, and removes it.
int take_number(const std::string& text, std::string_view& rest, const char* missing) {
  int number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error == std::errc::invalid_argument) refuse(text, missing);
  const auto length = static_cast<std::size_t>(end - rest.data());
  if (error != std::errc() || std::abs(number) > kLargestFrame)
    refuse(text, fmt::format("{} exceeds the maximum frame number {}", rest.substr(0, length), kLargestFrame));
  rest.remove_prefix(length);
  return number;
}

struct Pattern {
  std::size_t begin = std::string::npos, end = 0;
  int digits = 0;
};

/// Index of the first character after the folders.
std::size_t name_begin(const std::string& name) { return name.rfind('/') + 1; }

/// Finds the first frame pattern at or after `from`.
Pattern find_pattern(const std::string& name, std::size_t from) {
  for (std::size_t i = from; i < name.size(); ++i) {
    if (name[i] == '#') {
      const std::size_t end = std::min(name.find_first_not_of('#', i), name.size());
      if (end - i > 1) return {i, end, static_cast<int>(end - i)};
    } else if (name[i] == '%') {
      std::size_t end = i + 1;
      int digits = 0;
      for (; end < name.size() && name[end] >= '0' && name[end] <= '9' && digits < 100; ++end)
        digits = 10 * digits + (name[end] - '0');
      if (end < name.size() && name[end] == 'd' && digits < 100) return {i, end + 1, digits};
    }
  }
  return {};
}

}  // namespace

std::vector<int> parse_frames(const std::string& text) {
  std::vector<int> frames;
  std::set<int> seen;
  std::string_view rest = text;
  std::size_t count = 0;
  for (bool more = true; more;) {
    const int first = take_number(text, rest, "a number is missing");
    int last = first, step = 1;
    if (!rest.empty() && rest[0] == '-') {
      rest.remove_prefix(1);
      last = take_number(text, rest, "the end of a range is missing");
    }
    if (!rest.empty() && (rest[0] == ':' || rest[0] == 'x')) {
      rest.remove_prefix(1);
      step = take_number(text, rest, "the step must be an integer of at least 1");
      if (step < 1) refuse(text, "the step must be an integer of at least 1");
    }
    more = !rest.empty() && rest[0] == ',';
    if (more) {
      rest.remove_prefix(1);
    } else if (!rest.empty()) {
      refuse(text, fmt::format("unexpected `{}`", rest));
    }
    count += static_cast<std::size_t>(std::abs(last - first) / step) + 1;
    if (count > kMaxFrames) refuse(text, fmt::format("it has more than {} frames", kMaxFrames));
    const int signed_step = last < first ? -step : step;
    for (int f = first; signed_step > 0 ? f <= last : f >= last; f += signed_step)
      if (seen.insert(f).second) frames.push_back(f);
  }
  return frames;
}

std::string frames_text(const std::vector<int>& frames) {
  std::string out;
  for (std::size_t i = 0, end = 0; i < frames.size(); i = end) {
    for (end = i + 1; end < frames.size() && frames[end] == frames[end - 1] + 1;) ++end;
    out += fmt::format("{}{}", out.empty() ? "" : ",", frames[i]);
    if (end - i > 1) out += fmt::format("-{}", frames[end - 1]);
  }
  return out;
}

bool has_frame_pattern(const std::string& name) { return find_pattern(name, name_begin(name)).end > 0; }

void refuse_one_name(const std::string& name, std::size_t frames, const std::string& example) {
  const bool has_single = name.find('#') != std::string::npos;
  refuse(fmt::format("{} is one name for {} frames; add a frame pattern, e.g. {}{}", name, frames, example,
                     has_single ? "; a single # is an ordinary character, so write at least ##" : ""));
}

std::string with_frame(const std::string& name, int frame) {
  std::size_t at = name_begin(name);
  std::string out = name.substr(0, at);
  for (Pattern p = find_pattern(name, at); p.end > 0; p = find_pattern(name, at)) {
    out += name.substr(at, p.begin - at) + fmt::format("{:0{}}", frame, p.digits);
    at = p.end;
  }
  return out + name.substr(at);
}

bool is_sequence(const std::filesystem::path& input) {
  std::error_code ignored;
  return has_frame_pattern(input.string()) && !std::filesystem::exists(input, ignored);
}

std::string input_at_frame(const std::filesystem::path& folder, const std::string& name, int frame) {
  return is_sequence(folder / name) ? with_frame(name, frame) : name;
}

}  // namespace orrery::base
