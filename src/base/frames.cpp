// SPDX-License-Identifier: Apache-2.0
#include "base/frames.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string_view>

#include "base/error.h"

namespace orrery::base {
namespace {

constexpr int kLargestFrame = 9'999'999;
/// More names than anybody wants to see in a summary, and a year of film.
constexpr std::size_t kMostFrames = 1'000'000;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw Error(ErrorKind::kUsage, "`" + text + "` are no frames: " + why + "; write them like 1-10, 1-10x2 or 1,3,7-9");
}

/// Takes a number from the front of `text`.
bool take_number(std::string_view& text, int& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || std::abs(number) > kLargestFrame) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

struct Pattern {
  std::size_t begin = std::string::npos, end = 0;
  int digits = 0;
};

/// The first place for a frame at or behind `from`.
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
  for (bool more = true; more;) {
    int first = 0, last = 0, step = 1;
    if (!take_number(rest, first)) refuse(text, "a number is missing");
    last = first;
    if (!rest.empty() && rest[0] == '-') {
      rest.remove_prefix(1);
      if (!take_number(rest, last)) refuse(text, "a range has no end");
    }
    if (!rest.empty() && (rest[0] == ':' || rest[0] == 'x')) {
      rest.remove_prefix(1);
      if (!take_number(rest, step) || step < 1) refuse(text, "a step is a number from 1 on");
    }
    more = !rest.empty() && rest[0] == ',';
    if (more) {
      rest.remove_prefix(1);
    } else if (!rest.empty()) {
      refuse(text, "`" + std::string(rest) + "` is too much");
    }
    const int way = last < first ? -step : step;
    for (int f = first; way > 0 ? f <= last : f >= last; f += way) {
      if (seen.insert(f).second) frames.push_back(f);
      if (frames.size() > kMostFrames) refuse(text, "they are more than a million");
    }
  }
  return frames;
}

bool has_frame_pattern(const std::string& name) { return find_pattern(name, 0).end > 0; }

std::string with_frame(const std::string& name, int frame) {
  std::string out;
  std::size_t at = 0;
  for (Pattern p = find_pattern(name, 0); p.end > 0; p = find_pattern(name, at)) {
    char digits[128];
    std::snprintf(digits, sizeof(digits), "%0*d", p.digits, frame);
    out += name.substr(at, p.begin - at) + digits;
    at = p.end;
  }
  return out + name.substr(at);
}

}  // namespace orrery::base
