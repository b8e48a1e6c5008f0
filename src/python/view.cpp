// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "http/server.h"
#include "load/file_settings.h"
#include "python/render.h"
#include "python/scene_data.h"
#include "view/site.h"
#include "view/viewer.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

double noise_of(const std::string& text) {
  const double out = base::number_of<double>(text).value_or(0);
  if (!(out >= 1e-6 && out <= 1)) base::refuse(fmt::format("--noise {}: must be a number from 0.000001 to 1", text));
  return out;
}

/// Calls `use(option, value)` for each option among the page's words; --denoise has no value.
template <class Use>
void each_option(const std::vector<std::string>& words, Use use) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& option = words[i];
    use(option, option == "--denoise" ? std::string() : words[++i]);
  }
}

/// The subject of the page's words.
view::Subject subject_of(const SceneData& scene, const job::Job& job, const std::vector<std::string>& words) {
  view::Subject out;
  out.job = job;
  out.job.scene = scene.source();
  load::Overrides own;  // of the page
  each_option(words, [&](const std::string& option, const std::string& value) {
    if (option == "--denoise") {
      out.job.denoise = true;
    } else if (option == "--noise") {
      out.job.settings.noise = noise_of(value);
    } else {
      for (load::Overrides* const overrides : {&own, &out.job.scene.overrides}) {
        if (option == "--set")
          overrides->add(value);
        else
          overrides->add_option(option, (option == "--samples" ? "render." : "image.") + option.substr(2), value);
      }
    }
  });
  if (!load::named_files(own).empty()) base::refuse("set files in Python: scene.set(...)");
  return out;
}

/// A value of a scene file in Python.
std::string python_value(const std::string& text) {
  if (text == "true") return "True";
  if (text == "false") return "False";
  const bool is_literal = !text.empty() && std::string("+-.0123456789[\"'").find(text[0]) != std::string::npos;
  return is_literal ? text : "\"" + text + "\"";
}

/// The statements that make the picture of the page's words.
std::string statements(const std::vector<std::string>& words) {
  std::string out, rest;
  each_option(words, [&](const std::string& option, const std::string& value) {
    if (const std::size_t equals = value.find('='); option == "--set" && equals != std::string::npos)
      out += fmt::format("scene.set(\"{}\", {})\n", value.substr(0, equals), python_value(value.substr(equals + 1)));
    else if (option != "--set")
      rest += fmt::format(", {}={}", option.substr(2), option == "--denoise" ? "True" : value);
  });
  return out + "scene.render(" + (rest.empty() ? rest : rest.substr(2)) + ")";
}

/// A page in a browser that shows a scene of Python, served by this process until it is closed.
class ScenePage {
 public:
  ScenePage(SceneData scene, const std::string& title, std::map<std::string, std::string> options, int port,
            int threads, std::uint64_t memory_limit) {
    job::Job job;
    job.resources = {threads, memory_limit};
    view::Wish wish;
    for (const auto& [option, value] : options)
      wish.options[option] = option == "--denoise" ? std::vector<std::string>() : std::vector{value};
    viewer_ = std::make_unique<view::Viewer>(
        [scene = std::move(scene), job](const std::vector<std::string>& words) {
          return subject_of(scene, job, words);
        },
        std::vector<std::string>(), wish);
    view::Controls controls;
    controls.title = title;
    controls.command = statements;
    for (const char* const option : {"--samples", "--noise", "--width", "--height"})
      controls.options.push_back({option, "", "N", ""});
    controls.options.push_back({"--denoise", "", "", ""});
    controls.options.push_back({"--set", "", "KEY=VALUE", "", {}, true});
    controls.fills_window = wish.options.count("--width") + wish.options.count("--height") == 0;
    const std::string secret = view::random_secret();
    site_ = std::make_unique<view::Site>(*viewer_, std::move(controls), "127.0.0.1", secret);
    server_ = http::serve(
        "127.0.0.1", port, [this](const http::Request& request) { return site_->admits(request); },
        [this](const http::Request& request) { return site_->answer(request); });
    address_ = fmt::format("http://127.0.0.1:{}/?token={}", server_.port, secret);
  }

  /// With the secret. Empty: closed.
  const std::string& address() const { return address_; }

  /// The settings of the scene that is shown: KEY=VALUE, those of the controls and the camera.
  std::vector<std::string> settings() const {
    std::vector<std::string> out;
    if (viewer_)
      each_option(viewer_->state().words, [&](const std::string& option, const std::string& value) {
        if (option == "--set") out.push_back(value);
      });
    return out;
  }

  /// Ends the render and the server. Must not hold the GIL.
  void close() {
    address_.clear();
    if (viewer_) viewer_->stop();
    server_ = {};
    site_.reset();
    viewer_.reset();
  }

 private:
  std::string address_;
  std::unique_ptr<view::Viewer> viewer_;
  std::unique_ptr<view::Site> site_;
  http::Server server_;
};

}  // namespace

void bind_view(py::module_& m) {
  using ReleaseGil = py::call_guard<py::gil_scoped_release>;
  py::class_<ScenePage>(m, "ScenePage")
      .def(py::init<SceneData, const std::string&, std::map<std::string, std::string>, int, int, std::uint64_t>(),
           ReleaseGil())
      .def("address", &ScenePage::address)
      .def("settings", &ScenePage::settings)
      .def("close", &ScenePage::close, ReleaseGil());
}

}  // namespace orrery::python
