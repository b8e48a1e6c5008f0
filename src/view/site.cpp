// SPDX-License-Identifier: Apache-2.0
#include "view/site.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
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

// The files of the page by name: page.cpp.in. They are the same for everybody.
extern const std::map<std::string, const char*> kPageFiles;

namespace {

using Json = nlohmann::json;

/// How long a request for a frame waits. Proxies give up after a minute.
constexpr std::chrono::seconds kPatience{20};
constexpr std::size_t kMostLabels = 500, kMostObjects = 1000;  // of a legend, and of a list in the page

http::Response text(int status, const std::string& message) {
  return {status, "text/plain; charset=utf-8", std::make_shared<const std::string>(message + "\n")};
}

http::Response json_text(std::string text) {
  return {200, "application/json", std::make_shared<const std::string>(std::move(text))};
}

http::Response json(const Json& value) {
  // Messages may quote bytes of a file that are not UTF-8.
  return json_text(value.dump(-1, ' ', false, Json::error_handler_t::replace));
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

/// As read_wish() reads them.
Json json_of(const decltype(Wish::options)& options) {
  Json out = Json::object();
  for (const auto& [option, values] : options) out[option] = values.empty() ? Json(true) : Json(values);
  return out;
}

std::string hex_of(const math::Vec3d& display) {
  const auto code = [](double v) { return std::lround(255 * std::clamp(v, 0.0, 1.0)); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(display.x), code(display.y), code(display.z));
}

Json json_of(const annotation::LegendColors& legend) {
  Json labels = Json::array(), bar = Json::array();
  for (const auto& [label, color] : legend.labels)
    if (labels.size() < kMostLabels) labels.push_back({label, hex_of(color)});
  for (const math::Vec3d& color : legend.bar) bar.push_back(hex_of(color));
  Json out = {{"title", legend.title}, {"labels", labels}, {"bar", bar}, {"log", legend.is_log}};
  if (legend.range) out["range"] = {legend.range->low, legend.range->high};
  if (legend.nan_color) out["nan"] = hex_of(*legend.nan_color);
  return out;
}

Json json_of(const data::FrameInfo& data) {
  Json columns = Json::array();
  for (const data::ColumnInfo& column : data.columns) columns.push_back({column.name, data::type_name(column.type)});
  Json out = {{"rows", data.rows},    {"columns", columns},      {"position", data.roles.position},
              {"id", data.roles.id},  {"type", data.roles.type}, {"element", data.roles.element},
              {"header", data.header}};
  if (data.step) out["step"] = *data.step;
  if (data.box)
    out["box"] = {
        {"edges", {vector_of(data.box->edges[0]), vector_of(data.box->edges[1]), vector_of(data.box->edges[2])}},
        {"periodic", data.box->periodic}};
  return out;
}

/// Compares in a time that does not depend on where the texts differ.
bool is_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

/// The type of a file of the page.
std::string type_of(const std::string& name) {
  const std::string type = name.ends_with(".js") ? "javascript" : name.substr(name.rfind('.') + 1);
  return "text/" + type + "; charset=utf-8";
}

const std::set<std::string> kPosts = {"/wish", "/cancel", "/film/start", "/film/command", "/film/cancel"};
const std::set<std::string> kFilmOptions = {"--turntable", "--fps"};

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
    : viewer_(viewer),
      controls_(std::move(controls)),
      host_(std::move(host)),
      secret_(std::move(secret)),
      first_(viewer.state().wish) {}

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
  const bool is_post = kPosts.count(request.path) > 0;
  const std::string name = request.path == "/" ? "/view.html" : request.path;
  const auto file = request.method == "GET" ? kPageFiles.find(name) : kPageFiles.end();
  if (!is_for_us(request)) {
    out = text(403, "orrery view: open the address that the command printed, not another name of this machine");
  } else if (file != kPageFiles.end()) {
    out = {200, type_of(name), std::make_shared<const std::string>(file->second)};
  } else if (!admits(request)) {
    out = text(403, "orrery view: open the address that the command printed");
  } else if (request.method != (is_post ? "POST" : "GET")) {
    out = text(405, "method not allowed");
    out.fields.emplace_back("Allow", is_post ? "POST" : "GET");
  } else {
    last_request_ = Clock::now();
    try {
      out = answer_client(request);
    } catch (const base::Error& error) {
      out = text(error.kind() == base::ErrorKind::kUsage ? 400 : 500, text_of(error));
    }
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

http::Response Site::answer_client(const http::Request& request) {
  const std::string& path = request.path;
  if (path == "/page") return page();
  if (path == "/state") return state();
  if (path == "/frame") return frame(request);
  if (path == "/column" && controls_.column) return column(request);
  if (path == "/wish") return change(request);
  if (path == "/film/command" && controls_.film_command)
    return json({{"command", controls_.film_command(viewer_.words(wish_of(request)))}});
  if (path == "/cancel") viewer_.cancel();
  if (controls_.film) {
    if (path == "/film") return json_text(controls_.film_state());
    if (path == "/film/start") controls_.film(viewer_.words(wish_of(request)));
    if (path == "/film/cancel") controls_.film_cancel();
  }
  if (path == "/cancel" || (controls_.film && kPosts.count(path) > 0)) return json(true);
  const bool is_image = path == "/picture.png" || path == "/picture.exr";
  if (!is_image && path != "/pick" && path != "/scene.toml") return text(404, "not found");
  const auto client = request.query.find("client");
  if (client != request.query.end() && client->second != viewer_.state().wish.client)
    return text(409, "another page has asked since");
  if (path == "/scene.toml") return scene(request.query.count("brief") > 0);
  return is_image ? picture(path.substr(path.rfind('.'))) : pick(request);
}

/// What the page offers, which does not change.
http::Response Site::page() const {
  Json options = Json::array();
  for (const Control& control : controls_.options)
    options.push_back({{"name", control.name},
                       {"heading", control.heading},
                       {"type", control.type},
                       {"help", control.help},
                       {"values", control.values},
                       {"repeatable", control.is_repeatable}});
  return json({{"title", controls_.title},
               {"options", options},
               {"maps", controls_.maps},
               {"first", json_of(first_.options)},
               {"fills", controls_.fills_window},
               {"films", bool{controls_.film_command}},
               {"saves", bool{controls_.film}}});
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
    add("X-Client", frame.client);
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
  if (!viewer_.can_pick()) return text(409, "the scene is being read");
  const std::optional<Picked> picked = viewer_.pick(*x, *y);
  if (!picked) return json(nullptr);
  return json({{"title", picked->title},
               {"center", vector_of(picked->center)},
               {"radius", picked->radius},
               {"values", picked->values}});
}

http::Response Site::state() const {
  const State state = viewer_.state();
  const Subject& subject = *state.subject;
  Json out = {{"number", state.number},
              {"client", state.wish.client},
              {"asked", state.asked},
              {"read", state.read},
              {"served", state.served},
              {"options", json_of(state.wish.options)},
              {"chosen", subject.chosen},
              {"frames", subject.frame_count.value_or(0)},
              {"width", state.width},
              {"height", state.height},
              {"notes", subject.notes},
              {"warnings", state.warnings},
              {"legend", json_of(subject.legend)},
              {"activity", state.activity},
              {"progress", state.progress},
              {"problem", state.problem},
              {"fitted", state.wish.camera.empty()},
              {"up", vector_of(subject.up.value_or(math::Vec3d{0, 1, 0}))},
              {"command", controls_.command(state.words)}};
  out["camera"] = state.camera ? json_of(*state.camera) : Json();
  if (state.bounds) out["bounds"] = {vector_of((*state.bounds)[0]), vector_of((*state.bounds)[1])};
  out["data"] = subject.data ? json_of(*subject.data) : Json();
  return json(out);
}

http::Response Site::column(const http::Request& request) const {
  const auto frame = number_of<int>(request, "frame");
  const auto name = request.query.find("name");
  if (!frame || name == request.query.end()) return text(400, "`frame` must be a number, and `name` a column");
  try {
    return json_text(controls_.column(*frame, name->second, request.query.count("log") > 0));
  } catch (const base::Error&) {  // the page has reported it
    return json(nullptr);
  }
}

/// Reads the wish of a request, which may have options of films.
///
/// Errors     base::Error(kUsage)
Wish Site::wish_of(const http::Request& request) const {
  return read_wish(request.body, [&](const std::string& option) {
    const auto is_it = [&](const Control& control) { return control.name == option; };
    return std::any_of(controls_.options.begin(), controls_.options.end(), is_it) || option == kAllFrames ||
           (request.path != "/wish" && kFilmOptions.count(option) > 0);
  });
}

http::Response Site::change(const http::Request& request) {
  Wish wish = wish_of(request);
  const std::string command = controls_.command(viewer_.words(wish));
  return json({{"wish", viewer_.ask(std::move(wish))}, {"command", command}});
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

/// The scene file. `is_brief`: only the first objects of each kind, and without waiting for the image
http::Response Site::scene(bool is_brief) const {
  const std::shared_ptr<const job::Rendering> rendering = viewer_.finished();
  if (!rendering && !is_brief) return text(409, "the image is not finished yet");
  scene::Scene scene = load::authored_scene(is_brief ? viewer_.state().subject->job.scene : rendering->job.scene);
  if (is_brief) {
    scene.spheres.resize(std::min(scene.spheres.size(), kMostObjects));
    scene.rods.resize(std::min(scene.rods.size(), kMostObjects));
  }
  return download("scene.toml", "application/toml",
                  load::marked_text(load::scene_text(scene, "Written by orrery view")));
}

}  // namespace orrery::view
