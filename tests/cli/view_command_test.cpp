// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/http_client.h"

namespace orrery::test {
namespace {

using Json = nlohmann::json;

/// A running `orrery view`, and a client of it.
class Served {
 public:
  Served(const std::filesystem::path& folder, std::vector<const char*> words) {
    words.insert(words.begin(), {"orrery", "view"});
    words.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) std::abort();
    child_ = fork();
    if (child_ == 0) {
      const int messages = open((folder / ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (chdir(folder.c_str()) != 0) _exit(126);
      dup2(ends[1], STDOUT_FILENO);
      dup2(messages, STDERR_FILENO);
      execv(ORRERY_PROGRAM, const_cast<char* const*>(words.data()));
      _exit(127);
    }
    close(ends[1]);
    stdout_ = ends[0];
    for (char c = 0; read(stdout_, &c, 1) == 1 && c != '\n';) address_ += c;
    const std::size_t port = address_.find(":", 7), token = address_.find("token=");
    if (port != std::string::npos) port_ = std::atoi(address_.c_str() + port + 1);
    if (token != std::string::npos) secret_ = "Authorization: Bearer " + address_.substr(token + 6) + "\r\n";
  }
  ~Served() {
    if (child_ > 0) end(SIGKILL);
    stop_reading();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  const std::string& address() const { return address_; }
  int port() const { return port_; }

  support::HttpAnswer get(const std::string& path) const { return support::http_request(port_, "GET", path, secret_); }

  support::HttpAnswer post(const std::string& path, const Json& body) const {
    return support::http_request(port_, "POST", path, secret_, body.dump());
  }

  /// Requests an image and waits until it is complete, or refused.
  ///
  /// Result     the state of the page
  Json wish(const Json& wanted) const {
    const support::HttpAnswer answer = post("/wish", wanted);
    EXPECT_EQ(answer.status, 200) << answer.body;
    const int number = Json::parse(answer.body)["wish"];
    for (;;) {
      const Json state = Json::parse(get("/state").body);
      if (state["served"] >= number) return state;
      get("/frame?after=1000000000&state=" + state["number"].dump());  // waits for another state
    }
  }

  /// Closes the pipe from the program.
  void stop_reading() {
    if (stdout_ >= 0) close(std::exchange(stdout_, -1));
  }

  /// Ends the program. Result: exit status, or 128 + the signal that ended it
  int end(int number) {
    kill(child_, number);
    return wait();
  }
  int wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t child_ = 0;
  std::string address_, secret_;
  int port_ = 0, stdout_ = -1;
};

/// The settings that give a scene this camera, as the page writes them.
Json settings_of(const Json& camera) {
  Json out = Json::array();
  for (const char* const key : {"look_from", "look_at", "up"})
    out.push_back(std::string("camera.") + key + "=" + camera[key].dump());
  out.push_back((camera["perspective"] ? "camera.vfov=" : "camera.width=") + camera["size"].dump());
  return out;
}

class CliView : public ProgramTest {
 protected:
  void write_melt() {
    std::string text;
    for (int frame = 0; frame < 3; ++frame) {
      text +=
          "ITEM: TIMESTEP\n" + std::to_string(frame) +
          "\nITEM: NUMBER OF ATOMS\n27\nITEM: BOX BOUNDS pp pp pp\n0 3\n0 3\n0 3\nITEM: ATOMS id type x y z speed\n";
      for (int i = 0; i < 27; ++i)
        text += std::to_string(i + 1) + " " + std::to_string(1 + i % 2) + " " + std::to_string(i % 3) + " " +
                std::to_string(i / 3 % 3 + 0.1 * frame) + " " + std::to_string(i / 9) + " " +
                std::to_string(i * frame) + "\n";
    }
    write("melt.dump", text);
  }

  /// Runs the command that the page shows. Result: its exit status
  int run_shown(const Json& state) {
    std::string command = state["command"];
    EXPECT_EQ(command.substr(0, 7), "orrery ");
    return run(command.substr(7) + " -q").status;
  }

  /// Expects that the command which the page shows makes the picture that it shows.
  void expect_same_picture(const Served& view, const Json& state) {
    ASSERT_EQ(run_shown(state), 0) << state["command"] << text_of(folder_ / ".err");
    const support::HttpAnswer picture = view.get("/picture.png");
    ASSERT_EQ(picture.status, 200) << picture.body;
    write("page.png", picture.body);
    const Outcome same = run("compare page.png picture.png --fail-above max=0");
    EXPECT_EQ(same.status, 0) << state["command"] << same.out << same.err;
    const support::HttpAnswer frame = view.get("/frame?after=0");
    write("frame.png", frame.body);
    const Outcome seen = run("compare frame.png page.png --fail-above max=0");
    EXPECT_EQ(seen.status, 0) << state["command"] << seen.out << seen.err;
  }
};

TEST_F(CliView, RandomWalksThroughTheControlsMakeThePictureOfTheCommand) {
  write_melt();
  const Served view(folder_, {"melt.dump", "--width", "48", "--height", "36", "--samples", "2"});
  ASSERT_GT(view.port(), 0) << text_of(folder_ / ".err");
  std::mt19937 random(1);
  const auto choose = [&](const std::vector<Json>& values) { return values[random() % values.size()]; };
  const std::vector<std::pair<std::string, std::vector<Json>>> controls = {
      {"--color-by", {"", "speed", "type", "none", "no such column"}},
      {"--map", {"", "magma", "fast"}},
      {"--range", {"", "0:10", "5:1"}},
      {"--style", {"", "night", "flat"}},
      {"--material", {"", "plastic", "metal", "glass", Json::array({"matte", "type == 1: metal"})}},
      {"--bonds", {"", "length=1.5", "none", "file"}},
      {"--representation", {"", "spheres", "sticks"}},
      {"--select", {"", "type == 1", Json::array({"type != 2", "!(id in [1, 2])"}), "z > 0 && \"x\" < 2", "type =="}},
      {"--slice", {"", "z=1.5", Json::array({"x=2", "y=2"})}},
      {"--radius-scale", {"", "0.5", "1.2"}},
      {"--opacity", {"", "0.4", Json::array({"0.1", "type == 1: 0.8"}), "type == 1: 2"}},
      {"--ground", {"", true}},
      {"--box", {"", true}},
      {"--axes", {"", true}},
      {"--vectors", {"", "vx,vy,vz", "x,y"}},
      {"--denoise", {"", true}},
      {"--outline", {"", "2", "-1"}},
      {"--title", {"", "t = {step}", "{"}},
      {"--label", {"", "id == 1: Fe", Json::array({"id == 1: Fe", "id == 5: O"})}},
      {"--scale-bar", {"", "auto", "1 nm"}},
      {"--color-bar", {"", true}},
      {"--perspective", {"", "30"}},
      {"--center", {"", "type == 2"}},
      {"--background", {"", "black", "#102030"}},
      {"--look-from", {"", "+x", "30,20"}},
      {"--zoom", {"", "1.5"}},
      {"--replicate", {"", "2,1,1"}},
      {"--frame", {"", "2", "3", "4"}},
      {"--set", {"", Json::array({"render.seed=7", "image.overscan=0"}), "render.max_depth=3"}},
  };
  Json wanted = {{"options", {{"--width", "48"}, {"--height", "36"}, {"--samples", "2"}}}, {"moves", false}};
  int pictures = 0, problems = 0;
  while (pictures < 12 || problems < 3) {
    const auto& [option, values] = controls[random() % controls.size()];
    wanted["options"][option] = choose(values);
    const Json shown = view.wish(wanted);
    if (shown["problem"] != "") {
      ++problems;
      EXPECT_NE(run_shown(shown), 0) << shown["command"] << shown["problem"];
      wanted["options"].erase(option);
      continue;
    }
    ++pictures;
    if (random() % 2 == 0) {  // a moved camera
      Json camera = shown["camera"];
      for (Json& x : camera["look_from"]) x = x.get<double>() + 0.3 * static_cast<double>(random() % 10) - 1.4;
      wanted["camera"] = settings_of(camera);
      wanted["moves"] = true;
      view.wish(wanted);
      wanted["moves"] = false;
    }
    expect_same_picture(view, view.wish(wanted));
    if (HasFatalFailure()) return;
  }
}

TEST_F(CliView, PlayUsesTheRangeOfAllFrames) {
  write_melt();
  const Served view(folder_, {"melt.dump", "--width", "48", "--height", "36", "--samples", "2", "--color-by", "speed"});
  const Json options = {{"--width", "48"}, {"--height", "36"}, {"--samples", "2"}, {"--color-by", "speed"}};
  Json wanted = {{"options", options}};
  wanted["options"]["--frame"] = "2";
  EXPECT_EQ(view.wish(wanted)["chosen"]["--range"], "0:26");
  wanted["options"]["--frames"] = "all";
  const Json shown = view.wish(wanted);
  EXPECT_EQ(shown["problem"], "");
  EXPECT_EQ(shown["options"]["--range"][0], "0:52");
  expect_same_picture(view, shown);
  EXPECT_EQ(shown["legend"]["range"], Json({0, 52}));
  wanted["options"]["--color-bar"] = true;
  EXPECT_EQ(view.wish(wanted)["legend"]["bar"], Json::array()) << "it is in the image";
}

TEST_F(CliView, ACameraOfAnotherKindMakesThePictureOfTheCommand) {
  write_melt();
  const Served view(folder_, {"melt.dump", "--width", "48", "--height", "36", "--samples", "2"});
  Json camera = view.wish({{"options", {{"--width", "48"}, {"--height", "36"}, {"--samples", "2"}}}})["camera"];
  EXPECT_FALSE(camera["perspective"]);
  camera["perspective"] = true;
  camera["size"] = 40;
  camera["look_from"][0] = 7;
  expect_same_picture(view, view.wish({{"camera", settings_of(camera)},
                                       {"options", {{"--width", "32"}, {"--height", "36"}, {"--samples", "2"}}}}));
}

TEST_F(CliView, AScenesPictureIsThatOfTheCommand) {
  const Served view(folder_, {"good.toml", "--set", "camera.look_from=[0.5, 0.25, 2]"});
  const Json first = view.wish({{"options", {{"--set", "camera.look_from=[0.5, 0.25, 2]"}}}});
  expect_same_picture(view, first);
  expect_same_picture(view, view.wish({{"camera", settings_of(first["camera"])}, {"options", {{"--samples", "3"}}}}));
  // The scene that is saved makes it as well.
  write("saved.toml", view.get("/scene.toml").body);
  ASSERT_EQ(run("render saved.toml -o saved.png -q").status, 0);
  EXPECT_EQ(run("compare saved.png picture.png --fail-above max=0").status, 0);
}

TEST_F(CliView, IntAndTermEndItWithStatus0) {
  for (const int number : {SIGINT, SIGTERM}) {
    Served view(folder_, {"good.toml", "--samples", "60000"});
    ASSERT_EQ(view.get("/state").status, 200);
    EXPECT_EQ(view.end(number), 0);
    EXPECT_EQ(file_count(), 0);
  }
}

TEST_F(CliView, ItEndsWithTheReaderOfItsOutput) {
  Served view(folder_, {"good.toml"});
  ASSERT_EQ(view.get("/state").status, 200);
  view.stop_reading();
  EXPECT_EQ(view.wait(), 0);
}

TEST_F(CliView, TheBrowserFindsTheSecretInAFileThatOthersCannotRead) {
  std::filesystem::create_directory(folder_ / "bin");
  write("bin/xdg-open",
        "#!/bin/sh\necho \"$@\" > called\nstat -c %a \"$1\" > mode\ncat \"$1\" > page.tmp\nmv page.tmp page\n");
  std::filesystem::permissions(folder_ / "bin/xdg-open", std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", ((folder_ / "bin").string() + ":" + path).c_str(), 1);
  const Served view(folder_, {"good.toml", "--open"});
  setenv("PATH", path.c_str(), 1);
  while (!std::filesystem::exists(folder_ / "page")) ASSERT_EQ(view.get("/state").status, 200);
  EXPECT_TRUE(contains(text_of(folder_ / "page"), view.address()));
  EXPECT_FALSE(contains(text_of(folder_ / "called"), "token")) << "everybody can see the arguments of a program";
  EXPECT_EQ(text_of(folder_ / "mode"), "600\n");
}

TEST_F(CliView, APortInUseIsAnError) {
  const Served view(folder_, {"good.toml"});
  const Outcome second = run("view good.toml --port " + std::to_string(view.port()));
  EXPECT_EQ(second.status, 73);
  EXPECT_TRUE(contains(second.err, "--port")) << second.err;
}

TEST_F(CliView, AMissingFileIsAnErrorAtOnce) {
  const Outcome r = run("view nothing.pdb");
  EXPECT_EQ(r.status, 66);
  EXPECT_TRUE(contains(r.err, "nothing.pdb")) << r.err;
}

TEST_F(CliView, ANameThatScenesCannotHoldIsAnErrorAtOnce) {
  write("bad\xff.dump", "");
  const Outcome r = run("view 'bad\xff.dump'");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "is not valid UTF-8")) << r.err;
}

TEST_F(CliView, FramesAreSelectedInThePage) {
  EXPECT_FALSE(contains(run("view --help").out, "--frames"));
  const Outcome r = run("view a.dump --frames 1-2");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "unknown option --frames; did you mean `--frame`")) << r.err;
}

TEST_F(CliView, OthersAreNotServed) {
  const Served view(folder_, {"good.toml"});
  EXPECT_EQ(support::http_request(view.port(), "GET", "/state").status, 403) << "without the secret";
  EXPECT_EQ(support::http_request(view.port(), "GET", "/").status, 200) << "the page is no secret";
  EXPECT_EQ(view.get("/../good.toml").status, 404);
  EXPECT_EQ(view.get("/view.js%00").status, 404);
  EXPECT_TRUE(contains(view.address(), "http://127.0.0.1:")) << view.address();
}

TEST_F(CliView, APageMayNotNameFiles) {
  write("other.toml", "");
  const Served view(folder_, {"good.toml"});
  for (const char* setting : {"color.config=other.toml", "background={type=\"image\", file=\"other.toml\"}",
                              "points=[{file=\"other.toml\"}]"}) {
    const Json state = view.wish({{"options", {{"--set", setting}}}});
    EXPECT_NE(state["problem"], "") << setting;
    EXPECT_TRUE(contains(state["problem"], "start orrery view")) << state["problem"];
  }
}

TEST_F(CliView, AFilmMayNotNameFilesAndReplacesNone) {
  write("other.toml", "");
  write("film.0001.png", "mine");
  std::filesystem::create_directory(folder_ / "films");
  const Served view(folder_, {"good.toml", "--save-to", "films"});
  for (const char* setting : {"color.config=other.toml", "background={type=\"image\", file=\"other.toml\"}"}) {
    const Json wanted = {{"options", {{"--set", setting}, {"--frames", "1-2"}}}};
    const support::HttpAnswer answer = view.post("/film/start", wanted);
    EXPECT_EQ(answer.status, 400) << setting;
    EXPECT_TRUE(contains(answer.body, "start orrery view")) << answer.body;
  }
  EXPECT_EQ(view.post("/film/start", {{"options", {{"--frames", "1-2"}, {"--output", "x.png"}}}}).status, 400);
  for (const char* const file : {"film.0002.png", "film-2.0002.png"}) {
    EXPECT_EQ(view.post("/film/start", {{"options", {{"--frames", "1-2"}, {"--samples", "1"}}}}).status, 200);
    Json film;
    do film = Json::parse(view.get("/film").body);
    while (film["is_running"]);
    EXPECT_EQ(film["status"], 0) << film.dump();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "films" / file)) << file;
  }
  EXPECT_EQ(run("view good.toml --save-to nowhere").status, 66);
}

TEST_F(CliView, AFilmStopsWithAServerThatIsKilled) {
  std::filesystem::create_directory(folder_ / "films");
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // whose children become those of this process
  Served view(folder_, {"good.toml", "--save-to", "films"});
  const Json wanted = {{"options", {{"--frames", "1-2"}, {"--samples", "100000000"}}}};
  ASSERT_EQ(view.post("/film/start", wanted).status, 200);
  while (Json::parse(view.get("/film").body)["progress"].is_null()) {
  }
  EXPECT_EQ(view.end(SIGKILL), 128 + SIGKILL);
  int status = 0;
  waitpid(-1, &status, 0);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  ASSERT_TRUE(WIFEXITED(status));
  // While the threads of the server end one by one, the film may receive the signal twice, and then does not wait.
  EXPECT_TRUE(WEXITSTATUS(status) == 75 || WEXITSTATUS(status) == 128 + SIGINT) << WEXITSTATUS(status);
}

TEST_F(CliView, TheHistogramIsThatOfTheFrame) {
  write_melt();
  const Served view(folder_, {"melt.dump", "--width", "48", "--height", "36", "--samples", "2"});
  EXPECT_EQ(Json::parse(view.get("/column?frame=2&name=speed").body)["high"], 26);
  EXPECT_EQ(Json::parse(view.get("/column?frame=3&name=speed").body)["high"], 52);
  EXPECT_EQ(view.get("/column?frame=9&name=speed").body, "null");
  EXPECT_EQ(view.get("/column?frame=1&name=%3Cb%3E").body, "null");
}

TEST_F(CliView, ErrorsInThePageHaveThePlaceInTheFile) {
  write("wrong.toml", "[render]\nsamples = 0\n");
  const Served view(folder_, {"wrong.toml"});
  const std::string problem = view.wish(Json::object())["problem"];
  EXPECT_TRUE(contains(problem, "wrong.toml:2:11: error: ")) << problem;
  EXPECT_TRUE(contains(problem, "samples = 0\n")) << problem;
  EXPECT_TRUE(contains(problem, "^")) << problem;
}

TEST_F(CliView, FaultyOptionsAreErrorsInThePage) {
  write("faulty.dump", "nonsense");
  const Served view(folder_, {"faulty.dump"});
  const Json state = view.wish(Json::object());
  EXPECT_TRUE(contains(state["problem"], "faulty.dump: error: ")) << state["problem"];
  EXPECT_EQ(run("view good.toml --port 70000").status, 2);
  EXPECT_EQ(run("view good.toml --host nonsense").status, 2);
  EXPECT_EQ(run("view").status, 2);
}

}  // namespace
}  // namespace orrery::test
