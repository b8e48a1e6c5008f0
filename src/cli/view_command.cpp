// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/frames.h"
#include "base/input_file.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/films.h"
#include "cli/messages.h"
#include "cli/signals.h"
#include "cli/subject.h"
#include "http/server.h"
#include "info/data_info.h"
#include "load/read_scene.h"
#include "plot/named_columns.h"
#include "plot/plot.h"
#include "points/color_map.h"
#include "view/site.h"
#include "view/viewer.h"

namespace orrery::cli {
namespace {

struct ViewArguments {
  ShownOptions shown;
  std::string host = "127.0.0.1";
  int port = 0;
  bool opens = false, once = false;
  std::filesystem::path folder;    ///< of films; empty: none
  std::vector<const Option*> own;  ///< those that are not part of `shown`
};

/// With --once, a page that is reloaded within this time has not been closed.
constexpr std::chrono::seconds kGrace{30};

/// Options of the command that the page does not have: they do not change the image, or not in the same way again, or
/// name files.
bool is_control(const Option& option, bool is_scene) {
  const OptionText text = option.text();
  const bool is_of_data =
      base::contains({kDataOptions, kViewOptions, kLookOptions, kAnnotationOptions}, option.heading());
  return !option.name().empty() && !(is_scene && is_of_data) && text.type != "FILE" && text.type != "FONT" &&
         !base::contains({"--help", "--time", "--threads", "--memory-limit", "--layers"}, option.name());
}

/// Colours of a map for a gradient.
std::vector<std::string> gradient_of(const std::string& name) {
  constexpr int kSteps = 16;
  const points::ColorMap& map = *points::find_color_map(name);
  std::vector<std::string> out;
  for (int i = 0; i < kSteps; ++i) {
    const math::Vec3d c = points::srgb_at(map, i / (kSteps - 1.0));
    const auto code = [](double v) { return std::lround(255 * v); };
    out.push_back(fmt::format("#{:02x}{:02x}{:02x}", code(c.x), code(c.y), code(c.z)));
  }
  return out;
}

/// What the page offers.
///
/// `options`    those that it may set
/// `allowed`    the files that they may name
/// `points`     how it opens data files
view::Controls controls_of(const std::filesystem::path& file, const std::vector<const Option*>& options,
                           const std::set<std::string>& allowed, const scene::PointsKeys& points, Films* films) {
  view::Controls out;
  out.title = file.filename().string();
  const bool is_scene = load::is_scene_file(file);
  const std::string film = is_scene ? "film.####.png" : "film.mp4";
  const std::string command = is_scene ? "render" : "plot";
  const auto line = [=](const std::vector<std::string>& words, const std::string& output) {
    std::string text = fmt::format("orrery {} {}", command, base::shell_quoted(file.string()));
    for (const std::string& word : words) text += " " + base::shell_quoted(word);
    return text + " -o " + output;
  };
  out.command = [line](const std::vector<std::string>& words) { return line(words, "picture.png"); };
  out.film_command = [line, film](const std::vector<std::string>& words) { return line(words, film); };
  if (films != nullptr) {
    out.film = [=](const std::vector<std::string>& words) {
      check_film(file.string(), words, allowed);
      films->start(command, file, words, film);
    };
    out.film_state = [films] { return films->state(); };
    out.film_cancel = [films] { films->cancel(); };
  }
  for (const Option* const option : options) {
    const OptionText text = option->text();
    out.options.push_back(
        {option->name(), text.heading, text.type, text.description, text.choices, text.is_repeatable});
  }
  if (is_scene) return out;
  for (const std::string& name : points::color_map_names()) out.maps[name] = gradient_of(name);
  out.column = [file, component = points.component, topology = points.topology](int frame, const std::string& column,
                                                                                bool is_log) {
    const std::string name = base::input_at_frame({}, file.string(), frame);
    return info::column_values_json({name, name == file ? frame : 1, component, topology}, column, is_log);
  };
  return out;
}

/// Moves the values of controls from the command line to a wish, from which the page can change them.
view::Wish first_wish(const std::vector<const Option*>& options) {
  view::Wish out;
  for (const Option* const option : options) {
    const std::vector<std::string> words = option->arguments();
    for (std::size_t i = 0; i < words.size(); ++i) {
      std::vector<std::string>& values = out.options[option->name()];
      const std::size_t equals = words[i].find('=');
      if (words[i].starts_with("--") && equals != std::string::npos)
        values.push_back(words[i].substr(equals + 1));
      else if (!option->text().type.empty())
        values.push_back(words[++i]);
    }
  }
  return out;
}

/// Opens an address in the user's browser, without waiting for it. Everybody can see the arguments of a program, so the
/// browser finds the address, which contains the secret, in a file of `folder`, which others cannot read.
void open_in_browser(const std::string& address, const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / "orrery-view.html";
  std::ofstream(page) << fmt::format("<!doctype html>\n<meta http-equiv=\"refresh\" content=\"0; url={}\">\n", address);
  std::filesystem::permissions(page, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  // Results are printed to stdout, and a browser is talkative.
  const std::string command = fmt::format("exec xdg-open {} > /dev/null 2>&1", base::quoted(page.string()));
  std::FILE* const browser = popen(command.c_str(), "re");
  std::thread([browser] {
    if (browser == nullptr || pclose(browser) != 0)
      print_message("orrery: --open: no browser was found; open the address in a browser\n");
  }).detach();
}

/// True if nobody can read stdout any more: the pipe is closed, or the terminal or SSH connection has hung up.
bool reader_has_left() {
  pollfd out{STDOUT_FILENO, 0, 0};
  return poll(&out, 1, 0) > 0 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

int run_view(ViewArguments& arguments, const Command& command) {
  const std::filesystem::path& file = arguments.shown.plot.options.file;
  // The page reports all other faults; without a file there is nothing that it could change.
  if (!base::has_frame_pattern(file.filename().string())) base::require_readable(file);
  if (!load::is_scene_file(file)) plot::require_utf8(file.string());
  const std::set<std::string> allowed = files_of(arguments.shown);
  const auto is_in = [](const std::vector<const Option*>& list, const Option& option) {
    return std::find(list.begin(), list.end(), &option) != list.end();
  };
  std::vector<const Option*> options;
  for (const Option& option : command.options())
    if (!is_in(arguments.own, option) && is_control(option, load::is_scene_file(file))) options.push_back(&option);
  std::optional<Films> films;
  if (!arguments.folder.empty()) films.emplace(arguments.folder);
  view::Controls controls =
      controls_of(file, options, allowed, arguments.shown.plot.options.points, films ? &*films : nullptr);
  view::Wish first = first_wish(options);
  const std::vector<std::string> fixed = command.arguments([&](const Option& option) {
    return !option.name().empty() && !is_in(arguments.own, option) && !is_in(options, option);
  });
  controls.fills_window =
      first.options.count("--width") + first.options.count("--height") + first.options.count("--print-width") == 0;
  if (controls.fills_window) {  // until a page knows the size of its window
    first.options["--width"] = {"960"};
    first.options["--height"] = {"540"};
  }
  const std::atomic<bool>& stops = stop_on_signals();
  const auto make = [&](const std::vector<std::string>& words) { return subject_of(file, words, allowed); };
  view::Viewer viewer(make, fixed, first);
  const std::string secret = view::random_secret();
  view::Site site(viewer, controls, arguments.host, secret);
  const http::Server server = http::serve(
      arguments.host, arguments.port, [&](const http::Request& request) { return site.admits(request); },
      [&](const http::Request& request) { return site.answer(request); });
  const bool is_everywhere = arguments.host == "0.0.0.0";
  if (!arguments.host.starts_with("127."))
    print_message(fmt::format(
        "orrery: warning: the page is served on {}, to whoever has the printed address, and HTTP is not encrypted: "
        "who reads the network can read the secret; ssh -L and 127.0.0.1 are safer\n",
        is_everywhere ? "all IPv4 addresses of this machine" : arguments.host));
  const std::string address =
      fmt::format("http://{}:{}/?token={}", is_everywhere ? "127.0.0.1" : arguments.host, server.port, secret);
  print_result(address + "\n");
  const base::TempDir folder;
  if (arguments.opens) open_in_browser(address, folder.path());
  while (!stops && !reader_has_left() && !(arguments.once && site.idle() > kGrace))
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  viewer.stop();
  return 0;
}

}  // namespace

void add_view(Command& program) {
  const auto arguments = std::make_shared<ViewArguments>();
  Command& command = *program.add_subcommand("view", "Look at a scene or a data file in a browser");
  arguments->shown.add_to(command);
  arguments->own = {
      command.add_option("--port", arguments->port, "N", "Port to listen on; default: a free one")
          ->transform(whole_number(1, 65535)),
      command.add_option(
          "--host", arguments->host, "ADDRESS",
          "IPv4 address to listen on; default: 127.0.0.1, which only this machine reaches; 0.0.0.0: all, "
          "in a container"),
      command.add_option("--save-to", arguments->folder, "DIR",
                         "Folder into which the page may write films; default: none"),
      command.add_flag("--open", arguments->opens, "Open the page in the browser of this machine"),
      command.add_flag("--once", arguments->once, "End when the page has been closed"),
  };
  command.details(
      "Prints the address of a page and serves it until INT, TERM, or the end of stdout's reader. The address contains "
      "a secret; without --host, only 127.0.0.1 is served. On another machine: ssh -t -L PORT:127.0.0.1:PORT HOST, "
      "with "
      "--port PORT here. The page shows the command that makes its image. docs/view.md describes the page.");
  command.footer(
      "Examples:\n"
      "  orrery view melt.dump --color-by speed\n"
      "  orrery view scene.toml --port 8080");
  command.action([arguments, &command] { return run_view(*arguments, command); });
}

}  // namespace orrery::cli
