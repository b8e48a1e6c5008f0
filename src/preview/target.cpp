// SPDX-License-Identifier: Apache-2.0
#include "preview/target.h"

#include <charconv>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "preview/file_sink.h"
#include "preview/tev_sink.h"

namespace orrery::preview {
namespace {

[[noreturn]] void refuse(const std::string& text) {
  throw base::Error(base::ErrorKind::kUsage,
                    fmt::format("--preview: {}; write tev, tev:HOST:PORT, or the name of a .png file", text));
}

bool is_port(const std::string& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && number > 0 && number < 65536;
}

/// Parses HOST, HOST:PORT or [IPV6]:PORT.
Target tev_at(const std::string& address) {
  Target target{TargetKind::kTev, address, kTevPort, {}};
  std::size_t colon = address.rfind(':');
  if (address.starts_with('[')) {
    const std::size_t end = address.find(']');
    if (end == std::string::npos) refuse(fmt::format("`{}` lacks a closing bracket", address));
    if (end + 1 < address.size() && address[end + 1] != ':') refuse(fmt::format("`{}` is not an address", address));
    target.host = address.substr(1, end - 1);
    colon = end + 1 < address.size() ? end + 1 : std::string::npos;
  } else if (std::count(address.begin(), address.end(), ':') > 1) {
    refuse(fmt::format("`{}` is not an address; put an IPv6 address into brackets", address));
  } else {
    target.host = address.substr(0, colon);
  }
  if (colon != std::string::npos) target.port = address.substr(colon + 1);
  if (target.host.empty()) refuse(fmt::format("`{}` has no host", address));
  if (!is_port(target.port)) refuse(fmt::format("`{}` is not a port from 1 to 65535", target.port));
  return target;
}

}  // namespace

Target parse_target(const std::string& text) {
  if (text == "tev") return {TargetKind::kTev, kTevHost, kTevPort, {}};
  if (base::has_frame_pattern(text))
    throw base::Error(
        base::ErrorKind::kUsage,
        fmt::format("--preview: {} has a frame pattern; all frames share one preview, so write one name", text));
  if (base::extension(text) == ".png") return {TargetKind::kFile, {}, {}, text};
  if (text.starts_with("tev:")) return tev_at(text.substr(4));
  refuse(fmt::format("`{}` is not a preview", text));
}

std::unique_ptr<Sink> make_sink(const Target& target, const OnNote& note) {
  switch (target.kind) {
    case TargetKind::kNone: break;
    case TargetKind::kTev: return std::make_unique<TevSink>(target.host, target.port, note);
    case TargetKind::kFile: return std::make_unique<FileSink>(target.file);
  }
  return nullptr;
}

}  // namespace orrery::preview
