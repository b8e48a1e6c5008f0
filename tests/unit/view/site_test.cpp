// SPDX-License-Identifier: Apache-2.0
#include "view/site.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "fuzz/mutator.h"

namespace orrery::view {
namespace {

using Json = nlohmann::json;

constexpr const char* kSecret = "0123456789abcdef0123456789abcdef";

Subject small_subject(const std::vector<std::string>&) {
  Subject out;
  out.job.scene.file = "scene.toml";
  out.job.scene.text = std::make_shared<const std::string>("[image]\nwidth = 16\nheight = 8\n[render]\nsamples = 1\n");
  out.job.scene.has_file = false;
  out.data.emplace();
  out.data->columns = {{"speed"}, {"<b>\xff"}};
  out.notes = {"a note with a byte that is not UTF-8: \xff"};
  return out;
}

std::string command_of(const std::vector<std::string>& words) {
  std::string out = "orrery plot 'a file.dump'";
  for (const std::string& word : words) out += " " + base::shell_quoted(word);
  return out;
}

class ViewSite : public testing::Test {
 protected:
  ViewSite() : viewer_(small_subject, {}, {}), site_(viewer_, controls(), "127.0.0.1", kSecret) {}

  static Controls controls() {
    Controls out;
    out.title = "a file.dump";
    out.command = out.film_command = command_of;
    out.options = {{"--color-by", "Look options", "COLUMN", ""}, {"--style", "Look options", "STYLE", "", {"studio"}}};
    out.column = [](int frame, const std::string& column, bool) {
      if (column != "speed") base::refuse("no such column");
      return "{\"frame\": " + std::to_string(frame) + "}";
    };
    return out;
  }

  static http::Request request(const std::string& method, const std::string& path) {
    http::Request out;
    out.method = method;
    out.path = path;
    out.host = "127.0.0.1:4321";
    out.authorization = std::string("Bearer ") + kSecret;
    return out;
  }

  http::Response post(const std::string& body, const char* path = "/wish") {
    http::Request out = request("POST", path);
    out.body = body;
    return site_.answer(out);
  }

  Viewer viewer_;
  Site site_;
};

std::string field(const http::Response& response, const std::string& name) {
  for (const auto& [key, value] : response.fields)
    if (key == name) return value;
  return {};
}

TEST_F(ViewSite, OnlyTheSecretAdmits) {
  http::Request one = request("GET", "/state");
  EXPECT_EQ(site_.answer(one).status, 200);
  EXPECT_TRUE(site_.admits(one));
  for (const char* authorization :
       {"", "Bearer ", "0123456789abcdef0123456789abcdef", "Bearer 0123456789abcdef0123456789abcdee",
        "Bearer 0123456789abcdef0123456789abcdef0", "bearer 0123456789abcdef0123456789abcdef"}) {
    one.authorization = authorization;
    EXPECT_EQ(site_.answer(one).status, 403) << authorization;
    EXPECT_FALSE(site_.admits(one)) << authorization;
  }
  one.query["token"] = kSecret;
  EXPECT_EQ(site_.answer(one).status, 403) << "addresses are in histories and process lists";
}

TEST_F(ViewSite, OnlyThisHostAdmits) {
  http::Request one = request("GET", "/state");
  for (const char* host : {"localhost:4321", "127.0.0.1:4321", "[::1]:4321", "localhost:80"}) {
    one.host = host;
    EXPECT_EQ(site_.answer(one).status, 200) << host;
  }
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:", "evil.example:4321", "localhost.evil.example:4321",
                           "127.0.0.1:4321.evil.example"}) {
    one.host = host;
    EXPECT_EQ(site_.answer(one).status, 403) << host;
    EXPECT_FALSE(site_.admits(one)) << host;
    one.path = "/";
    EXPECT_EQ(site_.answer(one).status, 403) << "the page of " << host;
    one.path = "/state";
  }
  one.host = "127.0.0.1:4321";
  one.origin = "http://evil.example";
  EXPECT_EQ(site_.answer(one).status, 403) << "a page of another site cannot ask";
  one.origin = "http://127.0.0.1:4321";
  EXPECT_EQ(site_.answer(one).status, 200);
}

TEST_F(ViewSite, AllAddressesAreServedOnRequest) {
  const auto status = [this](const char* listens_on, const char* host) {
    Site site(viewer_, {"", command_of, {}}, listens_on, kSecret);
    http::Request one = request("GET", "/state");
    one.host = host;
    return site.answer(one).status;
  };
  EXPECT_EQ(status("0.0.0.0", "192.168.1.5:4321"), 200);
  EXPECT_EQ(status("0.0.0.0", "127.0.0.1:80"), 200);
  EXPECT_EQ(status("0.0.0.0", "evil.example:4321"), 403);
  EXPECT_EQ(status("192.168.1.5", "192.168.1.5:4321"), 200);
  EXPECT_EQ(status("192.168.1.5", "192.168.1.6:4321"), 403);
}

TEST_F(ViewSite, UnknownPathsAndMethodsAreRefused) {
  for (const char* path : {"/etc/passwd", "/../view.js", "//", "/frame/", "/picture.PNG", "/view.js.map"})
    EXPECT_EQ(site_.answer(request("GET", path)).status, 404) << path;
  const http::Response put = site_.answer(request("PUT", "/state"));
  EXPECT_EQ(put.status, 405);
  EXPECT_EQ(field(put, "Allow"), "GET");
  EXPECT_EQ(site_.answer(request("GET", "/wish")).status, 405);
  EXPECT_EQ(site_.answer(request("POST", "/")).status, 405);
}

TEST_F(ViewSite, ThePageHasAPolicyAndNoSecret) {
  http::Request without_secret = request("GET", "/");
  without_secret.authorization = "";
  const http::Response page = site_.answer(without_secret);
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(field(page, "Set-Cookie"), "") << "cookies are sent to every port of a host";
  EXPECT_EQ(page.body->find(kSecret), std::string::npos);
  const std::string policy = field(page, "Content-Security-Policy");
  EXPECT_NE(policy.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos) << "no scripts and styles within the page";
  EXPECT_EQ(page.body->find("http"), std::string::npos) << "nothing is loaded from elsewhere";
  std::size_t bytes = 0;
  for (const char* path : {"/", "/view.css", "/view.js", "/camera.js", "/data.js", "/legend.js", "/panel.js",
                           "/picks.js", "/picture.js", "/rules.js", "/scene.js", "/store.js", "/time.js", "/toasts.js"})
    bytes += site_.answer(request("GET", path)).body->size();
  EXPECT_LT(bytes, 120'000u);
}

TEST_F(ViewSite, StateNamesTheCommandAndTheControls) {
  EXPECT_EQ(post(R"({"options": {"--style": "a b", "--color-by": "speed"}})").status, 200);
  while (!viewer_.state().subject->data) viewer_.frame(1000000, std::chrono::milliseconds(10));
  const Json state = Json::parse(*site_.answer(request("GET", "/state")).body);
  EXPECT_EQ(state["command"], "orrery plot 'a file.dump' --color-by speed --style 'a b'");
  EXPECT_EQ(state["options"]["--style"], Json::array({"a b"}));
  EXPECT_EQ(state["data"]["columns"][0], Json({"speed", "float64"}));
  const Json page = Json::parse(*site_.answer(request("GET", "/page")).body);
  EXPECT_EQ(page["options"][1]["values"], Json::array({"studio"}));
  EXPECT_EQ(page["first"], Json::object());
}

TEST_F(ViewSite, APageIsAnsweredAboutItsOwnImageOnly) {
  EXPECT_EQ(post(R"({"client": "a"})").status, 200);
  for (const char* path : {"/pick", "/picture.png", "/scene.toml"}) {
    http::Request one = request("GET", path);
    one.query = {{"client", "b"}, {"x", "0.5"}, {"y", "0.5"}};
    EXPECT_EQ(site_.answer(one).status, 409) << path;
  }
  while (viewer_.frame(0, std::chrono::seconds(60)).client != "a") {
  }
}

TEST_F(ViewSite, ColumnsAreThoseOfTheData) {
  http::Request one = request("GET", "/column");
  one.query = {{"frame", "2"}, {"name", "speed"}};
  EXPECT_EQ(*site_.answer(one).body, "{\"frame\": 2}");
  one.query["name"] = "<b>";
  EXPECT_EQ(*site_.answer(one).body, "null") << "it is not known";
  one.query = {{"name", "speed"}};
  EXPECT_EQ(site_.answer(one).status, 400);
}

TEST_F(ViewSite, FilmsAreMadeOnlyIntoAFolderOfTheCommandLine) {
  const http::Response answer = post(R"({"options": {"--turntable": "4s", "--style": "studio"}})", "/film/command");
  EXPECT_EQ(Json::parse(*answer.body)["command"], "orrery plot 'a file.dump' --style studio --turntable 4s");
  EXPECT_EQ(post(R"({"options": {"--output": "x"}})", "/film/command").status, 400);
  EXPECT_EQ(post(R"({"options": {"--turntable": "4s"}})").status, 400) << "an option of films only";
  EXPECT_EQ(post("{}", "/film/start").status, 404);
  EXPECT_EQ(site_.answer(request("GET", "/film")).status, 404);
}

TEST_F(ViewSite, FramesHaveNumbers) {
  http::Request one = request("GET", "/frame");
  one.query["after"] = "0";
  http::Response frame = site_.answer(one);
  ASSERT_EQ(frame.status, 200);
  EXPECT_FALSE(frame.body->empty());
  EXPECT_EQ(frame.type.substr(0, 6), "image/");
  EXPECT_NE(field(frame, "X-Frame"), "");
  for (const char* after : {"-1", "x", "1.5", "", "99999999999999999999"}) {
    one.query["after"] = after;
    EXPECT_EQ(site_.answer(one).status, 400) << after;
  }
}

TEST_F(ViewSite, AnotherStateEndsTheWaitForAFrame) {
  http::Request one = request("GET", "/frame");
  one.query = {{"after", "1000000"}, {"state", "0"}};
  const http::Response none = site_.answer(one);
  EXPECT_EQ(none.status, 204);
  EXPECT_NE(field(none, "X-State"), "0");
  one.query["state"] = "x";
  EXPECT_EQ(site_.answer(one).status, 400);
}

TEST_F(ViewSite, PickedPlacesAreFractions) {
  http::Request one = request("GET", "/pick");
  for (const char* x : {"", "x", "-0.1", "1.1", "nan", "inf", "0.5x"}) {
    one.query = {{"x", x}, {"y", "0.5"}};
    while (!viewer_.can_pick()) viewer_.frame(1000000, std::chrono::milliseconds(10));
    EXPECT_EQ(site_.answer(one).status, 400) << x;
  }
  one.query["x"] = "0.5";
  const http::Response none = site_.answer(one);
  EXPECT_EQ(none.status, 200);
  EXPECT_EQ(*none.body, "null") << "the scene has no spheres";
}

TEST_F(ViewSite, FaultyWishesAreRefused) {
  for (const char* body : {
           "",
           "null",
           "[]",
           "1",
           "{",
           R"({"camera": 1})",
           R"({"camera": {}})",
           R"({"unknown": 1})",
           R"({"moves": 1})",
           R"({"options": []})",
           R"({"options": {"--style": 1}})",
           R"({"options": {"--style": false}})",
           R"({"options": {"--style": [1]}})",
           R"({"options": {"--output": "x.png"}})",
           R"({"client": 1})",
           R"({"options": {"--save-scene": "x.toml"}})",
           R"({"camera": ["background.file=x.exr"]})",
           R"({"camera": [1]})",
       })
    EXPECT_EQ(post(body).status, 400) << body;
  EXPECT_EQ(post(std::string(60'000, '[')).status, 400) << "deep nesting";
  EXPECT_EQ(post("{\"options\": {\"--style\": \"" + std::string(20'000, 'x') + "\"}}").status, 400);
}

TEST_F(ViewSite, DamagedWishesAreAnswered) {
  fuzz::Mutator mutator(
      1,
      {R"({"options": {"--style": "studio", "--color-by": "speed"}, "moves": true})",
       R"({"camera": ["camera.look_from=[0, 0, 1]", "camera.vfov=40"], "options": {}})"},
      {"{", "}", "[", "]", ":", ",", "\"", "null", "1e308", "-0", "\\ud800", "\"camera\"", "\"options\""});
  for (int i = 0; i < 20'000; ++i) {
    const std::string body = mutator.mutant();
    const int status = post(body).status;
    ASSERT_TRUE(status == 200 || status == 400) << body;
  }
}

}  // namespace
}  // namespace orrery::view
