// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
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
#include "cli/messages.h"
#include "cli/signals.h"
#include "cli/subject.h"
#include "http/server.h"
#include "load/read_scene.h"
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
  std::vector<const Option*> own;  ///< those that are not part of `shown`
};

/// With --once, a page that is reloaded within this time has not been closed.
constexpr std::chrono::seconds kGrace{30};

/// What the page may set, for a kind of file.
view::Controls controls_of(const std::filesystem::path& file) {
  view::Controls out;
  out.title = file.filename().string();
  const std::string command =
      fmt::format("orrery {} {}", load::is_scene_file(file) ? "render" : "plot", base::shell_quoted(file.string()));
  const auto line = [command](const std::vector<std::string>& words, const char* rest) {
    std::string text = command;
    for (const std::string& word : words) text += " " + base::shell_quoted(word);
    return text + rest;
  };
  out.command = [line](const std::vector<std::string>& words) { return line(words, " -o picture.png"); };
  out.film = [line](const std::vector<std::string>& words) {
    return line(words, " --set animation.turntable=120 --frames 1-120 -o film.####.png");
  };
  for (const char* option : {"--samples", "--noise", "--denoise", "--set", "--width", "--height"})
    out.options[option] = {};
  if (load::is_scene_file(file)) return out;
  out.options["--color-by"] = {"none", "element", "type", "rgb"};
  out.options["--map"] = points::color_map_names();
  out.options["--style"] = plot::style_names();
  out.options["--material"] = plot::material_names();
  out.options["--representation"] = plot::representation_names();
  out.options["--bonds"] = {"auto", "none", "file", "distance", "both"};
  out.options["--quality"] = plot::quality_names();
  out.options["--background"] = {"white", "black", "grey"};
  out.options["--scale-bar"] = {"auto"};
  for (const char* option :
       {"--ground",       "--opacity",      "--box",         "--axes",     "--vectors",   "--range",     "--select",
        "--slice",        "--radius-scale", "--radius",      "--color",    "--carbon",    "--look-from", "--fit",
        "--near",         "--far",          "--color-title", "--color-at", "--font-size", "--dpi",       "--frame",
        view::kAllFrames, "--perspective",  "--center",      "--title",    "--color-bar", "--label",     "--outline"})
    out.options[option] = {};
  return out;
}

/// Moves the values of controls from words to a wish, from which the page can change them.
view::Wish first_wish(std::vector<std::string>& words, const view::Controls& controls) {
  view::Wish out;
  std::vector<std::string> fixed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    const bool is_joined = words[i].starts_with("--") && equals != std::string::npos;
    const std::string option = is_joined ? words[i].substr(0, equals) : words[i];
    if (controls.options.count(option) == 0) {
      fixed.push_back(words[i]);
      continue;
    }
    std::string& value = out.options[option];
    if (!value.empty()) value += option == "--select" ? " && " : "\n";
    const std::string one = view::is_flag(option) ? "on" : is_joined ? words[i].substr(equals + 1) : words[++i];
    value += option == "--select" ? "(" + one + ")" : one;
  }
  if (controls.options.count("--style") > 0 && out.options.count("--width") + out.options.count("--height") == 0) {
    out.options["--width"] = "960";
    out.options["--height"] = "540";
  }
  words = std::move(fixed);
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
  const view::Controls controls = controls_of(file);
  const std::vector<const Option*>& own = arguments.own;
  std::vector<std::string> fixed = command.arguments([&](const Option& option) {
    return !option.name().empty() && std::find(own.begin(), own.end(), &option) == own.end();  // FILE has no name
  });
  const view::Wish first = first_wish(fixed, controls);
  const std::atomic<bool>& stops = stop_on_signals();
  const auto make = [&](const std::vector<std::string>& words) { return subject_of(file, words, allowed); };
  view::Viewer viewer(make, fixed, first);
  const std::string secret = view::random_secret();
  view::Site site(viewer, controls, arguments.host, secret);
  const auto server = http::serve(
      arguments.host, arguments.port, [&](const http::Request& request) { return site.admits(request); },
      [&](const http::Request& request) { return site.answer(request); });
  const bool is_everywhere = arguments.host == "0.0.0.0";
  if (!arguments.host.starts_with("127."))
    print_message(fmt::format(
        "orrery: warning: the page is served on {}, to whoever has the printed address, and HTTP is not encrypted: "
        "who reads the network can read the secret; ssh -L and 127.0.0.1 are safer\n",
        is_everywhere ? "all IPv4 addresses of this machine" : arguments.host));
  const std::string address =
      fmt::format("http://{}:{}/?token={}", is_everywhere ? "127.0.0.1" : arguments.host, server->port(), secret);
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
