// SPDX-License-Identifier: Apache-2.0
#include "view/site.h"

#include <sys/random.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "job/rendering.h"
#include "load/read_scene.h"
#include "load/write_scene.h"

namespace orrery::view {

// The files of the page: page.cpp.in.
extern const char *const kPageHtml, *const kPageStyle, *const kPageScript, *const kCameraScript;

namespace {

using Json = nlohmann::json;

/// How long a request for a frame waits. Proxies give up after a minute.
constexpr std::chrono::seconds kPatience{20};

http::Response text(int status, const std::string& message) {
  return {status, "text/plain; charset=utf-8", std::make_shared<const std::string>(message + "\n")};
}

http::Response json(const Json& value) {
  // Messages may quote bytes of a file that are not UTF-8.
  return {200, "application/json",
          std::make_shared<const std::string>(value.dump(-1, ' ', false, Json::error_handler_t::replace))};
}

/// A file for the client to save. `name` consists of characters that need no quotes.
http::Response download(const std::string& name, const std::string& type, std::string bytes) {
  http::Response out{200, type, std::make_shared<const std::string>(std::move(bytes))};
  out.fields.emplace_back("Content-Disposition", "attachment; filename=\"" + name + "\"");
  return out;
}

Json vector_of(const math::Vec3d& v) { return {v.x, v.y, v.z}; }

Json json_of(const scene::Camera& camera) {
  const bool is_perspective = camera.projection == scene::Projection::kPerspective;
  return {{"look_from", vector_of(camera.look_from)},
          {"look_at", vector_of(camera.look_at)},
          {"up", vector_of(camera.up)},
          {"perspective", is_perspective},
          {"size", is_perspective ? camera.vfov : camera.width.value_or(1)}};
}

/// Compares in a time that does not depend on where the texts differ.
bool is_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

/// The types and the texts of the page and the files that it loads. They are the same for everybody.
const std::map<std::string, std::pair<const char*, const char*>> kPageFiles = {
    {"/", {"text/html; charset=utf-8", kPageHtml}},
    {"/view.js", {"text/javascript; charset=utf-8", kPageScript}},
    {"/camera.js", {"text/javascript; charset=utf-8", kCameraScript}},
    {"/view.css", {"text/css; charset=utf-8", kPageStyle}}};

/// A number in the address of a request; empty if there is none.
template <class T>
std::optional<T> number_of(const http::Request& request, const char* name) {
  const auto found = request.query.find(name);
  return found != request.query.end() ? base::number_of<T>(found->second) : std::nullopt;
}

}  // namespace

std::string random_secret() {
  std::array<unsigned char, 16> bits{};
  if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size()))
    throw base::Error(base::ErrorKind::kIo, "the system has no random numbers");
  std::string out;
  for (const unsigned char byte : bits) out += fmt::format("{:02x}", byte);
  return out;
}

Site::Site(Viewer& viewer, Controls controls, std::string host, std::string secret)
    : viewer_(viewer), controls_(std::move(controls)), host_(std::move(host)), secret_(std::move(secret)) {}

std::chrono::seconds Site::idle() const {
  const Clock::time_point last = last_request_;
  if (last == Clock::time_point()) return {};
  return std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - last);
}

/// Whether a request names this host, and no other site made it.
bool Site::is_for_us(const http::Request& request) const {
  // Behind a tunnel the port is another one.
  const std::size_t colon = request.host.rfind(':');
  if (colon == std::string::npos || colon + 1 == request.host.size() ||
      request.host.find_first_not_of("0123456789", colon + 1) != std::string::npos)
    return false;
  const std::string name = request.host.substr(0, colon);
  // Listening on all addresses, it has names that are not known here. An address is no name of another site.
  const bool is_address = host_ == "0.0.0.0" && name.find_first_not_of("0123456789.") == std::string::npos;
  if (name != "127.0.0.1" && name != "localhost" && name != "[::1]" && name != host_ && !is_address) return false;
  return request.origin.empty() || request.origin == "http://" + request.host;
}

bool Site::admits(const http::Request& request) const {
  return is_for_us(request) && is_equal(request.authorization, "Bearer " + secret_);
}

http::Response Site::answer(const http::Request& request) {
  http::Response out;
  const bool is_post = request.path == "/wish";
  const auto file = request.method == "GET" ? kPageFiles.find(request.path) : kPageFiles.end();
  if (!is_for_us(request)) {
    out = text(403, "orrery view: open the address that the command printed, not another name of this machine");
  } else if (file != kPageFiles.end()) {
    out = {200, file->second.first, std::make_shared<const std::string>(file->second.second)};
  } else if (!admits(request)) {
    out = text(403, "orrery view: open the address that the command printed");
  } else if (request.method != (is_post ? "POST" : "GET")) {
    out = text(405, "method not allowed");
    out.fields.emplace_back("Allow", is_post ? "POST" : "GET");
  } else {
    last_request_ = Clock::now();
    if (is_post)
      out = change(request);
    else if (request.path == "/frame")
      out = frame(request);
    else if (request.path == "/state")
      out = state();
    else if (request.path == "/pick")
      out = pick(request);
    else if (request.path == "/picture.png")
      out = picture(".png");
    else if (request.path == "/picture.exr")
      out = picture(".exr");
    else if (request.path == "/scene.toml")
      out = scene();
    else
      out = text(404, "not found");
  }
  out.fields.emplace_back("Cache-Control", "no-store");
  out.fields.emplace_back("X-Content-Type-Options", "nosniff");
  out.fields.emplace_back("Referrer-Policy", "no-referrer");
  out.fields.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  out.fields.emplace_back("Content-Security-Policy",
                          "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
                          "connect-src 'self'; base-uri 'none'; form-action 'none'");
  return out;
}

/// The first image after that of number `after`, or 204 if there is none but another state than that of number `state`.
http::Response Site::frame(const http::Request& request) {
  const auto after = number_of<std::uint64_t>(request, "after"), known = number_of<std::uint64_t>(request, "state");
  if (!after || (!known && request.query.count("state") > 0)) return text(400, "`after` and `state` must be numbers");
  const Frame frame = viewer_.frame(*after, kPatience, known);
  http::Response out{204};
  const auto add = [&](const char* name, const std::string& value) { out.fields.emplace_back(name, value); };
  if (frame.number > *after) {
    out = {200, frame.type, frame.bytes};
    add("X-Frame", std::to_string(frame.number));
    add("X-Wish", std::to_string(frame.wish));
    add("X-Samples", fmt::format("{:.4g}", frame.samples));
    if (frame.noise) add("X-Noise", fmt::format("{:.2g}", *frame.noise));
    if (frame.is_finished) add("X-Finished", "1");
  }
  add("X-State", std::to_string(viewer_.state().number));
  return out;
}

/// The sphere at a point of the image; null where the background is visible.
http::Response Site::pick(const http::Request& request) {
  const auto x = number_of<double>(request, "x"), y = number_of<double>(request, "y");
  const auto is_fraction = [](const std::optional<double>& v) { return v && *v >= 0 && *v <= 1; };
  if (!is_fraction(x) || !is_fraction(y)) return text(400, "`x` and `y` must be numbers from 0 to 1");
  std::optional<Picked> picked;
  try {
    picked = viewer_.pick(*x, *y);
  } catch (const base::Error& error) {
    return text(500, text_of(error));
  }
  if (!picked) return json(nullptr);
  return json({{"title", picked->title},
               {"center", vector_of(picked->center)},
               {"radius", picked->radius},
               {"values", picked->values}});
}

http::Response Site::state() const {
  const State state = viewer_.state();
  Json options = Json::object();
  for (const auto& [option, values] : controls_.options) {
    const auto set = state.wish.options.find(option);
    const auto chosen = state.subject.chosen.find(option);
    options[option] = {{"value", set != state.wish.options.end() ? set->second : ""},
                       {"chosen", chosen != state.subject.chosen.end() ? chosen->second : ""},
                       {"values", values},
                       {"flag", is_flag(option)},
                       {"lines", is_repeated(option)}};
  }
  if (options.contains("--color-by"))
    for (const std::string& column : state.subject.columns) options["--color-by"]["values"].push_back(column);
  Json out = {{"number", state.number},
              {"title", controls_.title},
              {"options", options},
              {"frames", state.subject.frame_count.value_or(0)},
              {"width", state.width},
              {"height", state.height},
              {"first_size", state.first_size},
              {"notes", state.subject.notes},
              {"warnings", state.warnings},
              {"legend", state.subject.legend},
              {"activity", state.activity},
              {"problem", state.problem},
              {"served", state.served},
              {"fitted", !state.wish.camera},
              {"up", vector_of(state.subject.up.value_or(math::Vec3d{0, 1, 0}))},
              {"command", controls_.command(state.words)},
              {"film", controls_.film ? controls_.film(state.words) : ""}};
  out["camera"] = state.camera ? json_of(*state.camera) : Json();
  return json(out);
}

http::Response Site::change(const http::Request& request) {
  try {
    Wish wish = read_wish(request.body, [&](const std::string& option) { return controls_.options.count(option) > 0; });
    return json({{"wish", viewer_.ask(std::move(wish))}});
  } catch (const base::Error& error) {
    return text(400, error.what());
  }
}

http::Response Site::picture(const std::string& extension) const {
  const std::shared_ptr<const job::Rendering> rendering = viewer_.finished();
  if (!rendering) return text(409, "the image is not finished yet");
  const base::TempDir folder;
  const std::filesystem::path file = folder.path() / ("picture" + extension);
  job::Outputs outputs;
  outputs.images = {file};
  job::write_rendering(*rendering, outputs);
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return download("picture" + extension, extension == ".png" ? "image/png" : "image/x-exr", std::move(bytes));
}

http::Response Site::scene() const {
  const std::shared_ptr<const job::Rendering> rendering = viewer_.finished();
  if (!rendering) return text(409, "the image is not finished yet");
  const load::SceneSource& source = rendering->job.scene;
  return download("scene.toml", "application/toml",
                  load::marked_text(load::scene_text(load::authored_scene(source), "Written by orrery view")));
}

}  // namespace orrery::view
