// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/text.h"
#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "support/temp_dir.h"

namespace orrery::display {

extern const char* const kBuiltinConfig;

namespace {

/// A small config with one display of the given name.
std::string config_text(const std::string& display, const std::string& more = "") {
  return "ocio_profile_version: 2\nenvironment: {}\nsearch_path: tables\nstrictparsing: true\n"
         "roles: {default: lin_rec709, scene_linear: lin_rec709}\n"
         "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
         "displays:\n  " +
         display +
         ":\n    - !<View> {name: Plain, colorspace: out}\n"
         "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
         "  - !<ColorSpace>\n    name: out\n"
         "    from_reference: !<ExponentTransform> {value: [2, 2, 2, 1], direction: inverse}\n" +
         more;
}

class DisplayView : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }
  void TearDown() override { ::unsetenv("OCIO"); }

  std::string file(const std::string& name, const std::string& text) const {
    support::write_bytes(folder_ / name, text);
    return (folder_ / name).string();
  }

  static void expect_error(const Settings& settings, base::ErrorKind kind, const std::vector<std::string>& parts) {
    try {
      choose(settings);
      FAIL() << "no error";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      for (const std::string& part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << "\nlacks " << part;
    }
  }

  support::TempDir folder_;
};

TEST_F(DisplayView, TheNamedConfigOverridesTheEnvironmentAndTheBuiltIn) {
  EXPECT_EQ(choose({}).display, "sRGB");
  const std::string from_environment = file("a.ocio", config_text("Environment"));
  const std::string named = file("b.ocio", config_text("Named"));
  ::setenv("OCIO", from_environment.c_str(), 1);
  EXPECT_EQ(choose({}).display, "Environment");
  EXPECT_EQ(choose({}).config, from_environment);
  Settings settings;
  settings.config = named;
  EXPECT_EQ(choose(settings).display, "Named");
  EXPECT_EQ(choose(settings).config, named);
  ::setenv("OCIO", "", 1);
  EXPECT_EQ(choose({}).config, "built-in");
}

TEST_F(DisplayView, InvalidOptimizationFlagsAreNamed) {
  for (const char* flags : {"zz", "-1", "0x", "99999999999999999999", "1 2"}) {
    ::setenv("OCIO_OPTIMIZATION_FLAGS", flags, 1);
    expect_error({}, base::ErrorKind::kUsage, {"$OCIO_OPTIMIZATION_FLAGS is `" + std::string(flags) + "`"});
  }
  for (const char* flags : {"", "0", "0x1FF"}) {
    ::setenv("OCIO_OPTIMIZATION_FLAGS", flags, 1);
    EXPECT_EQ(choose({}).display, "sRGB") << flags;
  }
  ::unsetenv("OCIO_OPTIMIZATION_FLAGS");
}

/// The library's own message for a file of a later version is that of its parser.
TEST_F(DisplayView, ErrorsInConfigsNameTheVersionOfTheLibrary) {
  for (const char* name : {"a.ocioz", "b.ocio"}) {
    Settings settings;
    settings.config = file(name, std::string("PK\3\4\x14\0\0", 7));
    expect_error(settings, base::ErrorKind::kBadData, {"OpenColorIO " + ocio_version()});
  }
}

TEST_F(DisplayView, UsesTheTransformsOfAConfig) {
  Settings settings;
  settings.config = file("a.ocio", config_text("Root"));
  const film::Picture picture{1, 1, {{"R", {0.04f}}, {"G", {0.36f}}, {"B", {1}}}};
  EXPECT_EQ(develop(picture, settings, 8).values, (std::vector<std::uint16_t>{51, 153, 255}));
}

TEST_F(DisplayView, OcioMessagesAreNotPrinted) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  choose({});
  Settings settings;
  settings.config = file("a.ocio", config_text("Root"));
  choose(settings);
  settings.config = file("random.ocio", "\x01\x02\xff{{{");
  EXPECT_THROW(choose(settings), base::Error);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST_F(DisplayView, ReportsWarningsOfOcio) {
  Settings settings;
  settings.config = file("a.ocio", config_text("Root", "no_such_key: 3\n"));
  testing::internal::CaptureStderr();
  const Choice choice = choose(settings);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(choice.warnings.size(), 1u);
  EXPECT_NE(choice.warnings[0].find("no_such_key"), std::string::npos) << choice.warnings[0];
}

TEST_F(DisplayView, DifferentConfigsHaveDifferentIds) {
  Settings a, b;
  a.config = file("a.ocio", config_text("One"));
  b.config = file("b.ocio", config_text("Two"));
  EXPECT_NE(choose(a).config_id, choose(b).config_id);
  EXPECT_EQ(choose(a).config_id, choose(a).config_id);
}

TEST_F(DisplayView, UnknownNamesAreUsageErrorsWithTheKnownNames) {
  Settings settings;
  settings.display = "sRBG";
  expect_error(settings, base::ErrorKind::kUsage,
               {"no display `sRBG`", "did you mean `sRGB`?", "Gamma 2.0 Rec.709", "built-in"});
  settings = {};
  settings.view = "Un-tonemapped";
  expect_error(settings, base::ErrorKind::kUsage,
               {"did you mean `Un-tone-mapped`?", "ACES 1.0 SDR Video", "on display `sRGB`"});
  settings = {};
  settings.display = "Gamma 2.0 Rec.709";
  settings.view = "ACES 1.0 SDR Video";  // in the config, but not for this display
  expect_error(settings, base::ErrorKind::kUsage, {"it has Un-tone-mapped, Neutral, Raw"});
  settings = {};
  settings.look = "ACES 1.3 gamut compres";
  expect_error(settings, base::ErrorKind::kUsage, {"no look", "did you mean `ACES 1.3 gamut compress`?"});
  settings = {};
  settings.working_space = "lin_rec2020x";
  expect_error(settings, base::ErrorKind::kUsage, {"no colour space `lin_rec2020x`", "lin_rec709", "acescg"});
  settings.config = file("a.ocio", config_text("Root"));
  settings.working_space = "lin_rec709";
  settings.look = "any";
  expect_error(settings, base::ErrorKind::kUsage, {"it has none"});
}

TEST_F(DisplayView, AnExposureMustBeFinite) {
  Settings settings;
  settings.exposure = std::numeric_limits<double>::quiet_NaN();
  expect_error(settings, base::ErrorKind::kUsage, {"exposure"});
  settings.exposure = std::numeric_limits<double>::infinity();
  expect_error(settings, base::ErrorKind::kUsage, {"exposure"});
}

TEST_F(DisplayView, AMissingConfigIsAMissingInput) {
  Settings settings;
  settings.config = (folder_ / "none.ocio").string();
  expect_error(settings, base::ErrorKind::kMissingInput, {settings.config});
  settings.config = folder_.path().string();
  expect_error(settings, base::ErrorKind::kMissingInput, {settings.config});
  ::setenv("OCIO", (folder_ / "gone.ocio").c_str(), 1);
  expect_error({}, base::ErrorKind::kMissingInput, {"gone.ocio", "$OCIO"});
}

TEST_F(DisplayView, AnInvalidConfigIsBadData) {
  Settings settings;
  for (const std::string text : {"", "\x01\x02\xff", "not a config", "ocio_profile_version: 99\n", "a: [1, 2\n"}) {
    settings.config = file("bad.ocio", text);
    expect_error(settings, base::ErrorKind::kBadData, {settings.config});
  }
  std::string cut = kBuiltinConfig;
  settings.config = file("cut.ocio", cut.substr(0, cut.size() / 2));
  expect_error(settings, base::ErrorKind::kBadData, {settings.config});
}

TEST_F(DisplayView, TheWholeConfigIsValidated) {
  Settings settings;
  std::string text = config_text("Root");
  const std::string plain = "    - !<View> {name: Plain, colorspace: out}\n";
  text.insert(text.find(plain) + plain.size(), "    - !<View> {name: Other, colorspace: nowhere}\n");
  settings.config = file("a.ocio", text);
  settings.view = "Plain";  // valid itself
  expect_error(settings, base::ErrorKind::kBadData, {"nowhere"});
}

TEST_F(DisplayView, AMissingLutFileIsAMissingInput) {
  Settings settings;
  std::string text = config_text("Root");
  const std::string power = "!<ExponentTransform> {value: [2, 2, 2, 1], direction: inverse}";
  text.replace(text.find(power), power.size(), "!<FileTransform> {src: curve.spi1d, interpolation: linear}");
  settings.config = file("a.ocio", text);
  expect_error(settings, base::ErrorKind::kMissingInput, {"curve.spi1d"});
}

TEST_F(DisplayView, TheWorkingSpaceIsFoundByNameAliasRoleOrNameInOtherConfigs) {
  Settings settings;
  for (const char* name : {"lin_rec709", "lin_srgb", "scene_linear", "lin_rec709_scene", "Utility - Linear - sRGB"}) {
    settings.working_space = name;
    EXPECT_EQ(choose(settings).working_space, "lin_rec709") << name;
  }
  settings.working_space = "lin_ap1_scene";
  EXPECT_EQ(choose(settings).working_space, "acescg");
}

TEST_F(DisplayView, AnUnknownWorkingSpaceListsAllNamesTried) {
  Settings settings;
  settings.working_space = "lin_p3d65";
  expect_error(settings, base::ErrorKind::kUsage, {"`lin_p3d65`, nor under the names", "Linear P3-D65", "it has "});
}

TEST_F(DisplayView, DetectsAnHdrDisplay) {
  Settings settings;
  EXPECT_FALSE(choose(settings).is_hdr);
  settings.display = "Rec.2100-PQ";
  EXPECT_TRUE(choose(settings).is_hdr);
}

/// 1.0 is 100 cd/m2, which PQ encodes as 0.508.
TEST_F(DisplayView, PqMatchesItsStandard) {
  Settings settings;
  settings.display = "Rec.2100-PQ";
  film::Picture picture{1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}};
  const film::EncodedPicture shown = develop(picture, settings, 16);
  for (const std::uint16_t v : shown.values) EXPECT_NEAR(v / 65535.0, 0.5081, 2e-4);
}

TEST_F(DisplayView, LoadsTheConfigsOfTheAcesProject) {
  Settings settings;
  settings.config = "ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1";
  if (ocio_version() < "2.2") GTEST_SKIP() << "OpenColorIO " << ocio_version() << " has no built-in configs";
  EXPECT_EQ(choose(settings).working_space, "Linear Rec.709 (sRGB)");
  EXPECT_EQ(choose(settings).display, "sRGB - Display");
  settings.working_space = "acescg";
  EXPECT_EQ(choose(settings).working_space, "ACEScg");
}

/// The displays and their views in the table of docs/output.md.
std::vector<std::pair<std::string, std::vector<std::string>>> documented_displays() {
  std::istringstream in(support::file_bytes(std::filesystem::path(ORRERY_ROOT) / "docs" / "output.md"));
  const auto quoted = [](const std::string& text) {
    std::vector<std::string> names;
    for (std::size_t at = text.find('`'); at != std::string::npos; at = text.find('`', at + 1)) {
      const std::size_t end = text.find('`', at + 1);
      names.push_back(text.substr(at + 1, end - at - 1));
      at = end;
    }
    return names;
  };
  std::vector<std::pair<std::string, std::vector<std::string>>> out;
  std::string line;
  while (std::getline(in, line) && line.rfind("| display |", 0) != 0) {
  }
  std::getline(in, line);  // the rule below the header
  while (std::getline(in, line) && !line.empty()) {
    const std::size_t last = line.rfind('|', line.size() - 2);
    out.emplace_back(quoted(line).front(), quoted(line.substr(last)));
  }
  return out;
}

TEST_F(DisplayView, TheBuiltInDisplaysMatchTheDocumentation) {
  std::vector<std::string> displays;
  for (const auto& [display, views] : documented_displays()) {
    displays.push_back(display);
    Settings settings;
    settings.display = display;
    EXPECT_EQ(choose(settings).view, views.front()) << display;
    settings.view = "?";
    expect_error(settings, base::ErrorKind::kUsage, {"it has " + base::joined(views)});
    for (const std::string& view : views) {
      settings.view = view;
      EXPECT_EQ(choose(settings).view, view) << display;
    }
  }
  std::sort(displays.begin(), displays.end());
  Settings settings;
  settings.display = "?";
  try {
    choose(settings);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    std::string told = error.what();
    told = told.substr(told.find("it has ") + 7);
    std::vector<std::string> known;
    for (std::size_t at = 0; at < told.size();) {
      const std::size_t end = std::min(told.find(", ", at), told.size());
      known.push_back(told.substr(at, end - at));
      at = end + 2;
    }
    std::sort(known.begin(), known.end());
    EXPECT_EQ(known, displays);
  }
}

TEST_F(DisplayView, AViewThatTheDisplayLacksIsReplacedByTheDefault) {
  Settings settings;
  EXPECT_EQ(view_or_default(settings, "Raw"), "Raw");
  EXPECT_EQ(view_or_default(settings, "Plain"), "Un-tone-mapped");
  settings.config = file("a.ocio", config_text("d"));
  settings.view = "not used";
  EXPECT_EQ(view_or_default(settings, "Raw"), "Plain");
  settings.display = "none";
  EXPECT_EQ(view_or_default(settings, "Raw"), "Raw") << "look_up() reports the display";
}

}  // namespace
}  // namespace orrery::display
